-- Smoke that rises from a ball in a box of simulated air, for the sweeps beside this folder: one step
-- of the simulation a frame, so that times of a frame are times of a step.
local cells   = param { "cells", 96, min = 16, max = 512, integer = true, help = "along each side of the box" }
local carried = param { "carried", 2, min = 1, max = 3, integer = true, help = "of smoke, heat and a dye" }

local n  = cells:get()
local fx = effect { name = "air", fps = n, frames = 2 * n }
local air = lbm { size = {n, n, n}, voxel_size = 4 / n, position = {0, 0, -2}, speed = 0.5, time_step = 1 / n, boundary = "periodic" }
local ball = sphere { position = {0, 0, -1.2}, radius = 0.5 }
if carried:get() == 1 then air:source { shape = ball, rate = 4, density = 1 } end
if carried:get() == 2 then air:source { shape = ball, rate = 4, density = 1, temperature = 0.15 } end
if carried:get() == 3 then air:source { shape = ball, rate = 4, density = 1, temperature = 0.15, dye = 1 } end

fx.camera = camera { eye = {0, -8, 0.6}, target = {0, 0, 0}, fov = 40 }
fx.sun    = sun { azimuth = 215, elevation = 38, strength = 3 }
local volume = march { density = air.density * 8, albedo = {0.9, 0.9, 0.9}, steps = 96 }
fx.output = final { volume.color, tonemap = "reinhard" }.color
return fx
