-- A frame of 2.1 million cells: one step of air with smoke and heat, light through the smoke, and the
-- picture, which is what the fifth document draws. A cloud of smoke, 26 m wide, seen from outside.
--
--   roil render scripts/bench/effects/frame.lua --size 1920x1080 --frames 1200-1230

local fx = effect { name = "frame", fps = 60, frames = 1800 }
local steps = param { "steps", 1, min = 1, max = 16, integer = true, help = "of the simulation in a frame" }
local n  = param { "cells", 128, min = 32, max = 256, integer = true, help = "along each side of the box" }:get()

local air = lbm {
  size = {n, n, n}, voxel_size = 25.6 / n, speed = 1.2, time_step = 1 / (60 * steps:get()),
  buoyancy_heat = 0.4, boundary = { bottom = "wall", sides = "open", top = "open" },
}
local flicker = perlin { frequency = 0.5, speed = 0.5, octaves = 2 }
air:source { shape = sphere { position = {0, 0, 4}, radius = 2.6 }, density = 1 + flicker, temperature = 1 + flicker, rate = 4 }

fx.camera = orbit { target = {0, 0, 9}, distance = 34, yaw = 25, pitch = 8, fov = 30 }
fx.sun    = sun { azimuth = 160, elevation = 48, color = {1, 0.95, 0.88}, strength = 5 }
fx.sky    = sky { zenith = {0.10, 0.20, 0.42}, horizon = {0.42, 0.50, 0.60}, strength = 0.7 }

local lit    = lighting { density = air.density * 1.2, albedo = {0.9, 0.9, 0.9}, anisotropy = 0.2 }
local volume = march { from = {lit}, steps = 128, resolution = 0.5 }
local shown  = final { source = volume, tonemap = "aces" }
fx.output = shown.color
return fx
