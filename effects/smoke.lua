-- Smoke that is simulated: hot air rises from a small fire, rolls up and breaks into eddies. Nothing
-- is drawn by hand; what the air does follows from heat and viscosity.
--
--   roil render effects/smoke.lua --frames 72 -o smoke.png
--   roil render effects/smoke.lua --frames 72 --set lbm.buoyancy_heat=10 -o hotter.png

local fx = effect { name = "smoke", fps = 24, frames = 240 }

local density = param { "density", 5, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local heat    = param { "heat", 1, min = 0, max = 4, help = "temperature of the fire" }

-- Small enough for a computer without a graphics card. On one that has it, try {96, 96, 192} cells of 0.04 m.
local air = lbm {
    size = {32, 32, 64}, voxel_size = 0.12, speed = 6,
    buoyancy_heat = 4, cooling_rate = 0.3, dissolve_rate = 0.1,
    force = curl { frequency = 0.7, octaves = 2, speed = 0.8, seed = 4 } * 1.5, -- a restless day
}

-- Noise that moves through the fire breaks its evenness.
local flicker = perlin { frequency = 2, speed = 1.5, drift = {0, 0, 1.5}, octaves = 2 }
air:source {
    shape = sphere { position = {0, 0, 0.7}, radius = 0.6 },
    density = 1 + flicker, temperature = heat * (1 + flicker), rate = 12,
}

fx.camera = orbit { target = {0, 0, 3.4}, distance = 15, yaw = 25, pitch = 3, fov = 34 }
fx.sun    = sun { azimuth = 160, elevation = 48, color = {1, 0.95, 0.88}, strength = 5 }
fx.sky    = sky { zenith = {0.10, 0.20, 0.42}, horizon = {0.42, 0.50, 0.60}, strength = 0.7 }

local lit    = lighting { density = air.density * density, albedo = {0.96, 0.96, 0.97}, anisotropy = 0.2 }
local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit} }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
