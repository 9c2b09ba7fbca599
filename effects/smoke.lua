-- Smoke that is simulated: hot air rises from a fire of damp logs, rolls up and breaks into eddies.
-- Nothing is drawn by hand; what the air does follows from heat and viscosity, and noise is only for what
-- is finer than its cells.
--
--   roil render effects/smoke.lua --frames 72 -o smoke.png
--   roil render effects/smoke.lua --frames 72 --set lbm.buoyancy_heat=10 -o hotter.png

local fx = effect { name = "smoke", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

local density = param { "density", 12, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local heat    = param { "heat", 1, min = 0, max = 4, help = "temperature of the fire" }
local fire    = param { "fire", 1, min = 0, max = 10, help = "how bright it is" }

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

-- Noise stands for what is finer than a cell: eddies fold the smoke, and lumps that the air carries along
-- make it thick here and thin there, and eat it away where little is left.
local folds = curl { frequency = 1.1, octaves = 3, persistence = 0.6, drift = {0, 0, -0.8}, seed = 9 }:tile()
local lumps = worley { frequency = 2, octaves = 3, persistence = 0.6, lacunarity = 2.2, seed = 4 }
              :tile():advect(air.velocity, { period = 0.8, mean = 0.48 })
local cover = clamp(air.density:warp(folds, 0.25) * 1.8, 0, 1)
local smoke = cover * smoothstep(0, 0.9, cover - 1.3 * (1 - lumps) * (1 - 0.35 * cover))

-- A low sun from the side, a little from behind: each billow throws its shadow on the next.
fx.camera = orbit { target = {0, 0, 2.8}, distance = 10.5, yaw = 25, pitch = -6, fov = 34 }
fx.sun    = sun { azimuth = 190, elevation = 28, color = {1, 0.84, 0.64}, strength = 6.5 }
fx.sky    = sky { zenith = {0.02, 0.05, 0.16}, horizon = {0.14, 0.20, 0.32}, strength = 0.6 }

-- The fire itself is hidden; what one sees of it is its light, from within.
fx.lights = { point_light { position = {0, 0, 0.5}, color = {1, 0.34, 0.07}, power = fire * 1000 * (0.85 + 0.15 * sin(23 * time) * sin(31 * time)) } }

local lit    = lighting { density = smoke * density, albedo = {0.86, 0.86, 0.88}, anisotropy = 0.35, sampling = "linear" }
local scene  = geometry { mesh { "data/ground.obj", color = {0.55, 0.57, 0.6} }, mesh { "data/logs.obj", scale = 1.3 } }
local solid  = shade { from = {scene, lit}, haze = 0.01 }
local volume = march { from = {lit, scene}, steps = 128, jitter = 0.5 }

local picture = over { volume, solid, from = {volume, scene} }
local halo    = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown   = final { source = picture, bloom = halo, bloom_intensity = 0.3, exposure_ev = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
