-- A flame thrower against a wall: a jet of burning petrol strikes it, spreads, and licks over its top.
-- The wall is a mesh that the gas flows around, and the nozzle a source that goes on.
--
--   roil render effects/pyro_torch.lua --frames 40 -o torch.png

local fx = effect { name = "pyro torch", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local jet     = param { "jet", 24, min = 0, max = 40, unit = "m/s", help = "speed of the jet" }
local smoke   = param { "smoke", 8700, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides" }
local glow    = param { "glow", 1.4, min = 0, max = 50, help = "factor of the fire's light" }

-- A film is large: its fire is drawn at half of its size, and gas may cross more of its finer cells in a step.
local film = quality:get() == "film"

local cells = ({ draft = {96, 64, 80}, shot = {192, 128, 160}, film = {320, 224, 256} })[quality:get()]
local fire = pyro {
  size = cells, voxel_size = 9 / cells[1], fuel = "petrol", speed = film and 17 or 24, velocity_cells = "half", density = "variable",
  burn_time = 0.05, cooling = 1800, vorticity = 3, soot_yield = 0.02,
}

local flicker = perlin { frequency = 1, speed = 6, octaves = 2 }
fire:source {
  shape = sphere { position = {-1.8, 0, 1.2}, radius = 0.14 },
  fuel = 0.5, temperature = 850, velocity = vec(jet, 0, 1) * (0.8 + 0.4 * flicker), during = {0, 3},
}
local wall = mesh { "data/wall.obj", position = {1.6, 0, 0} }
fire:collider { wall }

fx.camera = orbit { target = {-0.3, 0, 2.2}, distance = 15, yaw = -25, pitch = 8, fov = 36 }
fx.sun    = sun { azimuth = 215, elevation = 20, color = {1, 0.85, 0.7}, strength = 1 }
fx.sky    = sky { zenith = {0.02, 0.035, 0.08}, horizon = {0.08, 0.09, 0.12}, strength = 0.6 }

local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local flame = smoothstep(900, 1400, fire.temperature)
local cover = fire.soot * smoke + flame * 1.2
local lit = lighting {
  density = cover, emission = light(fire.temperature) * cover * flame * glow,
  albedo = 0.3, anisotropy = 0.3, sampling = "cubic",
}

local scene  = geometry { mesh { "data/ground.obj" }, wall }
local solid  = shade { from = {scene, lit}, haze = 0.002 }
local volume = march { from = {lit, scene}, steps = 160, jitter = 0.5, resolution = film and 0.5 or 1 }

local picture = over { volume, solid, from = {volume, scene} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
