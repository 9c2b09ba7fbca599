-- A dragon breathes: hot smoke is blown out of the back of its gullet, past palate, tongue and jaw, which
-- are all in its way, and the jaw opens and shuts while it flows. What is hot glows, then it is smoke.
--
--   roil render effects/creature.lua --frames 50 -o creature.png
--   roil render effects/creature.lua --frames 50 --set heat=0 --set throat=0 -o smoker.png   -- only smoke
--
-- Play with `breath` (a curve: how hard it blows), `open` (the jaw), `heat` and `lift`.

local fx = effect { name = "creature", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 160 x 64 x 96; taken when the effect loads" }
local density = param { "density", 12, min = 0, max = 50, unit = "1/m", help = "how thick the smoke is" }
local heat    = param { "heat", 2500, min = 0, max = 3000, unit = "K", help = "of the breath in the throat" }
local glowing = param { "glowing", 5, min = 0, max = 50, help = "factor of the fire's light" }
local lift    = param { "lift", 2.2, min = -5, max = 10, unit = "m/s^2", help = "how fast its heat makes it rise" }
local eaten   = param { "eaten", 1.4, min = 0, max = 2, help = "how much noise finer than a cell eats from the smoke" }
local folded  = param { "folded", 0.06, min = 0, max = 0.2, unit = "m", help = "how far eddies finer than a cell carry the smoke" }
local throat  = param { "throat", 45, min = 0, max = 500, unit = "W", help = "of the light in its mouth" }

-- Four seconds of breath: how hard it blows, and how far the jaw is open (degrees).
local breath = curve { {0, 0}, {0.35, 0}, {0.7, 1}, {2.2, 0.8}, {2.9, 0}, {4, 0}, shape = "ease_in_out", period = 4 }
local open   = curve { {0, 5}, {0.3, 8}, {0.7, 29}, {2.4, 24}, {3.1, 6}, {4, 5}, shape = "ease_in_out", period = 4 }

-- What the air meets is closed and coarse; what is seen has scales, horns and teeth, far finer than a cell.
local hinge, gape = {-0.115, 0, 1.656}, vec(0, open, 0)
local head = mesh { "data/creature.obj" }
local jaw  = mesh { "data/creature_jaw.obj", position = hinge, rotation = gape }
local hide = {
  mesh { "data/creature_hide.obj" },
  mesh { "data/creature_jaw_hide.obj", position = hinge, rotation = gape },
}

-- From the middle of the neck to where the breath has spread: 5.6 x 2.24 x 3.36 metres.
local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(160), cells(64), cells(96)}, voxel_size = 5.6 / cells(160), position = {1.9, 0, 0.3},
  boundary = "open", beside_bodies = "velocity", -- sharper in a throat of few cells
  buoyancy_heat = lift, cooling_rate = 0.5, dissolve_rate = 0.15, speed = 6,
}

-- Both bodies stand in its way, and the jaw pushes on the air as it moves; "solid": teeth are thinner than
-- cells, and would close the mouth if each were made a whole one. The gullet has but one end, so that the
-- source must hold the pressure: new air comes with the smoke.
air:collider { head, jaw, rule = "solid" }
local flutter = perlin { frequency = 3, speed = 5, octaves = 2, seed = 2 }
air:source {
  mesh { "data/creature_throat.obj" }, rule = "solid",
  density = breath, temperature = breath * (0.6 + 0.8 * flutter),
  velocity = vec(9, 0, 1) * breath * min(0.6 + 0.8 * flutter, 1.1), pressure = 0, -- below what `speed` leaves room for
}

-- What is finer than a cell is not in the air. Noise stands for it, carried along by the air, and eats at
-- the smoke where that is thin. What is hardly there is left out: no samples are taken where nothing is.
local lumps = worley { frequency = 3, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.4, mean = 0.48 })
local folds = curl { frequency = 3, octaves = 3, persistence = 0.6, drift = {-2, 0, 0}, speed = 0.8, seed = 9 }:tile()
local spread = folded * smoothstep(0, 1, position.x) -- they need room, which the mouth has not
local cover = smoothstep(0.03, 0.42, air.density:warp(folds, spread))
local smoke = cover * smoothstep(0, 0.3, cover - eaten * (1 - lumps) * (1 - 0.7 * cover))
local hot   = clamp(1.15 * air.temperature:warp(folds, spread) - 0.1, 0, 1.2)
local fire  = palette { blackbody = {300, 3500}, physical = true, reference = 1500 }

-- Moonlight from above and behind on horns, brow and crest, a warm light from beside on the scales, and that of the
-- fire in the mouth.
fx.sun    = sun { azimuth = 60, elevation = 22, color = {0.5, 0.66, 1}, strength = 1.6 }
fx.sky    = sky { zenith = {0.006, 0.010, 0.022}, horizon = {0.030, 0.034, 0.05}, strength = 1 }
fx.lights = {
  spot_light { position = {-2.0, -0.4, 5.2}, target = {0, 0, 1.7}, color = {0.55, 0.72, 1}, power = 3600, angle = 66, softness = 0.8, radius = 0.15 },
  spot_light { position = {-2.2, -4.5, 0.8}, target = {0, 0, 1.5}, color = {1, 0.55, 0.3}, power = 420, angle = 50, softness = 0.6 },
  point_light { position = {0.45, 0, 1.75}, color = {1, 0.42, 0.1}, power = throat * breath },
}
fx.camera = camera { eye = {2.9, -5.6, 0.95}, target = {1.2, 0, 1.72}, fov = 28, near = 0.1, far = 500 }

local lit = lighting {
  density = smoke * density, emission = fire(hot ^ 0.5 * (0.5 + 0.85 * lumps) * heat) * smoke * smoothstep(0.04, 0.3, hot) * glowing,
  albedo = {0.3, 0.29, 0.28}, anisotropy = 0.35, fire_lights = 1, sampling = "cubic",
}
local scene  = geometry { mesh { "data/ground.obj", color = {0.10, 0.105, 0.12} }, table.unpack(hide) }
local solid  = shade { from = {scene, lit}, sky_samples = 8, shadow_samples = 8, haze = 0.01 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.25, exposure_ev = 0.8, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
