-- A large sequence, played back. tests/bench/make_volume writes cloud_*.vdb beside a copy of this file.
local fx = effect { name = "volume", fps = 24, frames = 48 }
local storage = param { "storage", "auto", words = {"auto", "dense", "sparse"}, help = "of a frame on the device" }
local hot     = param { "hot", true, help = "with a second grid, temperature" }
local blend   = param { "blend", false, help = "mixes neighbouring frames" }
local light   = param { "light", true, help = "lit by the pass `lighting`; else it glows evenly" }
local steps   = param { "steps", 256, min = 1, max = 1024, integer = true, help = "along each ray" }

local cloud = vdb { "cloud_*.vdb", fps = 24, loop = "repeat", storage = storage:get(), blend = blend:get() }
local fire  = palette { blackbody = {600, 2200}, physical = true }

fx.camera = camera { eye = {0, -4.2, 1.5}, target = {0, 0, 0.9}, fov = 36 }
fx.sun    = sun { azimuth = 230, elevation = 35, strength = 4 }
fx.sky    = sky { zenith = {0.2, 0.32, 0.6}, horizon = {0.6, 0.65, 0.7}, strength = 0.7 }

local glow = hot:get() and fire(cloud.temperature) * cloud.density * 8 or nil
local medium = { density = cloud.density * 60, emission = glow, albedo = {0.9, 0.88, 0.85}, anisotropy = 0.3 }
local plain  = { density = cloud.density * 60, emission = cloud.density * (glow or 1) * 20, steps = steps }
local volume = march(light:get() and { from = lighting(medium), steps = steps } or plain)
local shown  = final { source = volume, tonemap = "aces" }

fx.output = shown.color
