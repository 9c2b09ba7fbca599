-- A campfire: gas from hot wood rises between the logs, burns where it finds air, and flames tear off.
-- The logs are a mesh that the gas flows around.
--
--   roil render effects/pyro_campfire.lua --frames 48 -o campfire.png

local fx = effect { name = "pyro campfire", fps = 24, frames = 144, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local gas     = param { "gas", 0.1, min = 0, max = 2, unit = "kg/m^3", help = "that the wood gives off" }
local burning = param { "burning", 1.5, min = 0, max = 10, unit = "s", help = "before the first frame" }
local smoke   = param { "smoke", 8700, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides" }
local glow    = param { "glow", 1.4, min = 0, max = 50, help = "factor of the fire's light" }

-- A film is large: its fire is drawn at half of its size.
local film = quality:get() == "film"

local cells = ({ draft = {64, 64, 80}, shot = {128, 128, 160}, film = {192, 192, 256} })[quality:get()]
local fire = pyro {
  size = cells, voxel_size = 2 / cells[1], fuel = "wood", speed = 6, warm_up = burning:get(),
  velocity_cells = "half", density = "variable", burn_time = 0.05, cooling = 800, vorticity = 3,
  force = curl { frequency = 1.2, octaves = 2, speed = 1.5, seed = 2 } * 2, -- a breath of wind
}

-- Embers among the logs: here and there, now more, now less.
local beds = worley { frequency = 3.5, speed = 0.4, octaves = 2, seed = 9 }
fire:source {
  shape = sphere { position = {0, 0, 0.1}, radius = 0.34 } * smoothstep(0.35, 0.6, beds + 0.2),
  fuel = gas, temperature = 850, velocity = {0, 0, 0.4}, rate = 6,
}
local logs = mesh { "data/logs.obj" }
fire:collider { logs }

fx.camera = camera { eye = {0.6, -4.6, 0.85}, target = {0, 0, 0.85}, fov = 32, near = 0.05, far = 500 }
fx.sun    = sun { azimuth = 60, elevation = 40, color = {0.55, 0.7, 1}, strength = 0.04 } -- the moon
fx.sky    = sky { zenith = {0.003, 0.005, 0.012}, horizon = {0.010, 0.012, 0.020} }

local ripple = worley { frequency = 6, octaves = 2, persistence = 0.6, seed = 8 }
               :tile():advect(fire.velocity, { period = 0.3, mean = 0.48 })
local kelvin = fire.temperature * (0.85 + 0.3 * ripple)

-- Wood burns clean: its flame gives light by what little soot is in it.
local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local flame = smoothstep(900, 1400, kelvin)
local cover = fire.soot * smoke + flame * 2.5
local lit = lighting {
  density = cover, emission = light(kelvin) * cover * flame * glow,
  albedo = 0.4, anisotropy = 0.3, sampling = "cubic",
}

local scene  = geometry { mesh { "data/ground.obj", color = {1.8, 1.7, 1.6} }, logs }
local solid  = shade { from = {scene, lit}, haze = 0.002 }
local volume = march { from = {lit, scene}, steps = 160, jitter = 0.5, resolution = film and 0.5 or 1 }

local picture = over { volume, solid, from = {volume, scene} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.35, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
