-- A cloud of dust in a room, lit at its far end: a flame runs through the mixture, pushes what has not
-- burnt out of the open door, and follows it.
--
--   roil render effects/pyro_dust.lua --frames 20 -o dust.png

local fx = effect { name = "pyro dust", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local dust    = param { "dust", 0.12, min = 0, max = 1, unit = "kg/m^3", help = "in the air of the room; air burns 0.23 of it" }
local flame   = param { "flame_speed", 2, min = 0, max = 50, unit = "m/s", help = "into mixture at rest" }
local smoke   = param { "smoke", 900, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides" }
local haze    = param { "haze", 6, min = 0, max = 100, unit = "m^2/kg", help = "what 1 kg of dust hides" }
local glow    = param { "glow", 1.6, min = 0, max = 50, help = "factor of the fire's light" }

-- A film is large: its fire is drawn at half of its size.
local film = quality:get() == "film"

-- A box of 10 x 20 x 8 m round the room; walls are two cells of the velocity thick.
local cells = ({ draft = {80, 160, 64}, shot = {160, 320, 128}, film = {240, 480, 192} })[quality:get()]
local fire = pyro {
  size = cells, voxel_size = 10 / cells[1], position = {0, -5.5, 0}, fuel = "dust", speed = 30,
  velocity_cells = "half", density = "variable", combustion = "premixed", flame_speed = flame,
  cooling = 1300, soot_yield = 0.05, soot_burn_time = 0, vorticity = 8,
}

-- It hangs in the room in swathes, and is lit in a corner.
local swathes = worley { frequency = 0.9, octaves = 3, seed = 4 }:remap(0.1, 0.7, 0.2, 1.8)
fire:source { shape = box { position = {0, 1.5, 1.5}, size = {4, 4, 3} }, fuel = dust * swathes, during = {0, 0.01} }
fire:source { shape = sphere { position = {-0.9, 2.7, 1.1}, radius = 0.4 }, temperature = 1500, during = {0.01, 0.06} }
local room = mesh { "data/room.obj", color = {0.62, 0.6, 0.56} }
fire:collider { room, rule = "solid" }

fx.camera = camera { eye = {-19, -13, 4}, target = {0, -5.2, 2.2}, fov = 38 }
fx.sun    = sun { azimuth = 230, elevation = 28, color = {1, 0.9, 0.78}, strength = 5 }
fx.sky    = sky { zenith = {0.08, 0.16, 0.36}, horizon = {0.34, 0.42, 0.52}, strength = 0.7 }

local ripple = worley { frequency = 1.8, octaves = 3, persistence = 0.6, seed = 8 }
               :tile():advect(fire.velocity, { period = 0.3, mean = 0.48 })
local kelvin = fire.temperature * (0.82 + 0.42 * ripple)

-- Dust that has not burnt is pale haze; what burns glows as bright as it is dense.
local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local hot   = smoothstep(900, 1400, kelvin)
local burns = (fire.soot * smoke + hot * 1.2) * (0.4 + 1.2 * ripple)
local cover = burns + fire.fuel * haze * (0.5 + ripple)
local lit = lighting {
  density = cover, emission = light(kelvin) * burns * hot * glow,
  albedo = 0.8, tint = mix(vec(0.9, 0.82, 0.66), vec(0.35, 0.32, 0.3), smoothstep(400, 900, fire.temperature)),
  anisotropy = 0.3, sampling = "cubic",
}

local scene  = geometry { mesh { "data/ground.obj" }, room }
local solid  = shade { from = {scene, lit}, haze = 0.002 }
local volume = march { from = {lit, scene}, steps = 192, jitter = 0.5, resolution = film and 0.5 or 1 }

local picture = over { volume, solid, from = {volume, scene} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
