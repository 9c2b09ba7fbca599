-- A ball of fuel that burns in a box of gas, for the sweep beside this folder: one step of the
-- simulation a frame, so that times of a frame are times of a step.
local cells = param { "cells", 64, min = 16, max = 512, integer = true, help = "along each side of the box" }

local n  = cells:get()
local fx = effect { name = "pyro", fps = 120, frames = 480 }
local fire = pyro { size = {n, n, n}, voxel_size = 4 / n, position = {0, 0, -2}, time_step = 1 / 120 }
fire:source { shape = sphere { position = {0, 0, -1.2}, radius = 0.5 }, fuel = 0.3, temperature = 900, rate = 10 }

fx.camera = camera { eye = {0, -8, 0.6}, target = {0, 0, 0}, fov = 40 }
fx.sun    = sun { azimuth = 215, elevation = 38, strength = 3 }
local volume = march { density = fire.soot * 2000, albedo = {0.3, 0.3, 0.3}, steps = 96 }
fx.output = final { volume.color, tonemap = "reinhard" }.color
return fx
