-- A tall cloud: a great ball of hot air and dust rises for a minute, in five seconds of film, rolls into a
-- ring, draws up a stem, and spreads.
--
--   roil render effects/pyro_mushroom.lua --frames 72 -o mushroom.png

local fx = effect { name = "pyro mushroom", fps = 24, frames = 120, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local heat    = param { "heat", 3000, min = 300, max = 6000, unit = "K", help = "of the ball at first" }
local smoke   = param { "smoke", 30, min = 0, max = 1000, unit = "m^2/kg", help = "what 1 kg of its dust hides" }
local glow    = param { "glow", 2, min = 0, max = 50, help = "factor of the fire's light" }

-- A film is large: its fire is drawn at half of its size, and gas may cross more of its finer cells in a step.
local film = quality:get() == "film"

-- A box of 1.5 x 1.5 x 1.9 km, in which 12 seconds pass in one.
local cells = ({ draft = {96, 96, 128}, shot = {192, 192, 256}, film = {320, 320, 416} })[quality:get()]
local fire = pyro {
  size = cells, voxel_size = 1500 / cells[1], fuel = "dust", speed = film and 80 or 110, time_scale = 12,
  velocity_cells = "half", density = "variable", cooling = 60, soot_burn_time = 0, vorticity = 0.06,
}

-- The ball, rough at its edge, and the dust of the ground around it, which is drawn into the stem.
local lumps = worley { frequency = 0.012, octaves = 3, seed = 3 }:remap(0.1, 0.7, 0, 1)
local whirl = curl { frequency = 0.008, octaves = 3, seed = 5 }
fire:source {
  shape = sphere { position = {0, 0, 190}, radius = 170 },
  temperature = heat * (0.6 + 0.5 * lumps), soot = 0.0012 * (0.5 + lumps), velocity = whirl * 25, during = {0, 0.05},
}
fire:source {
  shape = box { position = {0, 0, 15}, size = {1200, 1200, 30} },
  soot = 0.002 * lumps * smoothstep(600, 100, length(position * vec(1, 1, 0))), during = {0, 0.05},
}

fx.camera = orbit { target = {0, 0, 700}, distance = 3000, yaw = 25, pitch = 2, fov = 34, near = 10, far = 60000 }
fx.sun    = sun { azimuth = 235, elevation = 22, color = {1, 0.86, 0.68}, strength = 6 }
fx.sky    = sky { zenith = {0.08, 0.16, 0.36}, horizon = {0.42, 0.44, 0.48}, strength = 0.8 }

local ripple = worley { frequency = 0.016, octaves = 3, persistence = 0.6, seed = 8 }
               :tile():advect(fire.velocity * 12, { period = 0.6, mean = 0.48 })
local kelvin = fire.temperature * (0.85 + 0.35 * ripple)

local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local hot   = smoothstep(800, 1300, kelvin)
local cover = clamp(fire.soot * smoke + hot * 0.004, 0, 0.05) * (0.4 + 1.2 * ripple) -- nowhere denser than a thick cloud
local lit = lighting {
  density = cover, emission = light(kelvin) * cover * hot * glow,
  albedo = {0.62, 0.56, 0.5}, anisotropy = 0.3, sampling = "cubic",
}

local scene  = geometry { mesh { "data/ground.obj", scale = 200, color = {1.1, 0.95, 0.8} } }
local solid  = shade { from = {scene, lit}, haze = 0.00004 }
local volume = march { from = {lit, scene}, steps = 192, jitter = 0.5, resolution = film and 0.5 or 1 }

local picture = over { volume, solid, from = {volume, scene} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
