-- Gas that burns: fuel comes out of a small pool, and goes up in flames and soot.
local fx = effect { name = "fire", fps = 24, frames = 120, author = "the roil authors", licence = "MIT" }

local smoke = param { "smoke", 8700, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides" }
local glow  = param { "glow", 2, min = 0, max = 50, help = "factor of the fire's light" }

local fire = pyro { size = {32, 32, 64}, voxel_size = 0.08, fuel = "petrol", speed = 8, vorticity = 2 }
local flicker = perlin { frequency = 2, speed = 4, octaves = 2 }
local pool = sphere { position = {0, 0, 0.2}, radius = 0.35 }
fire:source { shape = pool, fuel = 0.2, temperature = 900, velocity = vec(0, 0, 1.5) * (1 + flicker) }

fx.camera = orbit { target = {0, 0, 2.2}, distance = 9, pitch = 5 }
fx.sky    = sky { zenith = {0.02, 0.03, 0.07}, horizon = {0.06, 0.07, 0.1}, strength = 0.6 }

local light  = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local flame  = smoothstep(900, 1400, fire.temperature)
local cover  = fire.soot * smoke + flame
local lit    = lighting { density = cover, emission = light(fire.temperature) * cover * flame * glow, albedo = 0.3 }
local volume = march { from = {lit}, steps = 96 }
local blooms = bloom { bright { volume, threshold = 1 }, radius = 0.6 }

fx.output = final { source = volume, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }.color
return fx
