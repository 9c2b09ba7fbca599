-- Smoke that is simulated: hot air rises from a small fire, rolls up and breaks into eddies. Nothing
-- is drawn by hand; what the air does follows from heat and viscosity, and noise is only for what is
-- finer than its cells.
--
--   roil render effects/smoke.lua --frames 72 -o smoke.png
--   roil render effects/smoke.lua --frames 72 --set lbm.buoyancy_heat=10 -o hotter.png

local fx = effect { name = "smoke", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

local density = param { "density", 7, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
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

-- Noise that the air carries along eats at the smoke where that is thin.
local lumps = worley { frequency = 1.5, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.8, mean = 0.48 })
local cover = clamp(air.density * 4, 0, 1)
local smoke = cover * smoothstep(0, 0.6, cover - 1.5 * (1 - lumps) * (1 - 0.5 * cover))

fx.camera = orbit { target = {0, 0, 3.4}, distance = 15, yaw = 25, pitch = 3, fov = 34 }
fx.sun    = sun { azimuth = 215, elevation = 36, color = {1, 0.90, 0.76}, strength = 8 }
fx.sky    = sky { zenith = {0.04, 0.11, 0.32}, horizon = {0.32, 0.42, 0.56}, strength = 0.7 }

local lit    = lighting { density = smoke * density, albedo = {0.96, 0.96, 0.97}, anisotropy = 0.2, sampling = "cubic" }
local scene  = geometry { mesh { "data/ground.obj", color = {0.7, 0.75, 0.6} } }
local solid  = shade { from = {scene, lit}, haze = 0.01 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
