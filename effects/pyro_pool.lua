-- A pan of petrol on the ground: the flame necks, rolls up and puffs, about 1.5 / sqrt(D) times a
-- second for a pan D metres wide. Nobody says so here: air drawn in from the sides makes it.
--
--   roil render effects/pyro_pool.lua --frames 60 -o pool.png

local fx = effect { name = "pyro pool", fps = 24, frames = 144, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local width   = param { "width", 0.9, min = 0.2, max = 2, unit = "m", help = "of the pan" }
local burning = param { "burning", 2.5, min = 0, max = 10, unit = "s", help = "before the first frame" }
local smoke   = param { "smoke", 8700, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides" }
local glow    = param { "glow", 1.8, min = 0, max = 50, help = "factor of the fire's light" }

local cells = ({ draft = {64, 64, 96}, shot = {128, 128, 192}, film = {192, 192, 320} })[quality:get()]
local fire = pyro {
  size = cells, voxel_size = 4.8 / cells[1], fuel = "petrol", speed = 9, warm_up = burning:get(),
  velocity_cells = "half", density = "variable", burn_time = 0.06, cooling = 700, vorticity = 4,
}

-- Vapour rises slowly from the pan, hot enough to go on burning.
local disc = sphere { position = {0, 0, 0}, radius = width / 2 } * box { position = {0, 0, 0.06}, size = {4, 4, 0.12} }
local flicker = perlin { frequency = 3, speed = 2, octaves = 2 }
fire:source {
  shape = disc,
  fuel = 0.5, temperature = 620, velocity = vec(0, 0, 0.1 + 0.1 * flicker), rate = 4,
}

fx.camera = orbit { target = {0, 0, 2.4}, distance = 10, yaw = 20, pitch = 4, fov = 36 }
fx.sky    = sky { zenith = {0.01, 0.014, 0.03}, horizon = {0.03, 0.035, 0.05}, strength = 0.6 }

local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local flame = smoothstep(850, 1300, fire.temperature)
local cover = fire.soot * smoke + flame * 0.8
local lit = lighting {
  density = cover, emission = light(fire.temperature) * cover * flame * glow,
  albedo = 0.3, anisotropy = 0.3, sampling = "cubic",
}

local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit}, haze = 0.002 }
local volume = march { from = {lit, scene}, steps = 160, jitter = 0.5 }

local picture = over { volume, solid, from = {volume, scene} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
