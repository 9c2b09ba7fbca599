-- Smoke that is simulated: hot air rises from a small fire and breaks into eddies.
local fx = effect { name = "smoke", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

local density = param { "density", 12, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local heat    = param { "heat", 1, min = 0, max = 4, help = "temperature of the fire" }

-- The air that smoke moves in: a box of cells. More of them show more, and take longer.
local air = lbm { size = {32, 32, 64}, voxel_size = 0.06, speed = 5, buoyancy_heat = 4, cooling_rate = 0.3 }

-- What gives it smoke and heat, unevenly.
local flicker = perlin { frequency = 4, speed = 1.5, octaves = 2 }
local fire = sphere { position = {0, 0, 0.4}, radius = 0.25 }
air:source { shape = fire, density = 1 + flicker, temperature = heat * (1 + flicker), rate = 12 }

fx.camera = orbit { target = {0, 0, 1.8}, distance = 7, pitch = 5 }
fx.sun    = sun { azimuth = 215, elevation = 36, strength = 6 }
fx.sky    = sky { zenith = {0.1, 0.2, 0.4}, horizon = {0.4, 0.5, 0.6}, strength = 0.7 }

local lit    = lighting { density = air.density * density, albedo = {0.95, 0.95, 0.95}, anisotropy = 0.2 }
local volume = march { from = {lit}, steps = 96 }

fx.output = final { source = volume, tonemap = "aces" }.color
return fx
