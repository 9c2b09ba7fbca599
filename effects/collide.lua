-- Two jets of smoke meet around a lamp. The air is simulated, and nothing steers it but two nozzles and
-- the smoke's own heat: where the jets meet they push each other up, roll over the light and mix.
--
--   roil render effects/collide.lua --frames 96 -o collide.png
--   roil render effects/collide.lua --frames 96 --set detail=1 -o fine.png   -- 16 times the work
--
-- Play with `speed` (fast jets tear each other up, slow ones only lean together), `lift` (how hot the
-- smoke is) and `uneven` (how much the jets flutter); then with `power` and the two colours.

local fx = effect { name = "collide", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 128 x 64 x 96; taken when the effect loads" }
local density = param { "density", 9, min = 0, max = 50, unit = "1/m", help = "how thick the smoke is" }
local speed   = param { "speed", 3.2, min = 0, max = 5, unit = "m/s", help = "of the jets" }
local lift    = param { "lift", 1.3, min = -5, max = 10, unit = "m/s^2", help = "how fast their heat makes them rise" }
local uneven  = param { "uneven", 0.8, min = 0, max = 3, unit = "m/s", help = "how much the jets flutter" }
local eaten   = param { "eaten", 1.2, min = 0, max = 2, help = "how much noise finer than a cell eats from the smoke" }
local folded  = param { "folded", 0.1, min = 0, max = 0.3, unit = "m", help = "how far eddies finer than a cell carry the smoke" }
local power   = param { "power", 420, min = 0, max = 5000, unit = "W", help = "of the lamp" }
local colors  = { param { "left", {0.66, 0.84, 1}, color = true, help = "of the left jet's smoke" },
                  param { "right", {1, 0.74, 0.70}, color = true, help = "of the right jet's smoke" } }

-- A box of air of 6.4 x 3.2 x 4.8 metres on the ground. Cells are cubes, and a side has a multiple of 8.
local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(128), cells(64), cells(96)}, voxel_size = 6.4 / cells(128),
  boundary = { bottom = "wall", sides = "open", top = "open" },
  buoyancy_heat = lift, cooling_rate = 0.1, dissolve_rate = 0, speed = 4,
}

-- Each nozzle is a ball in which the air is what we say: full of smoke, warm, and moving. Noise makes it
-- flutter. The dye is a second smoke, which goes where the first goes: it says which jet some came from.
local flutter = curl { frequency = 1.3, speed = 1.5, seed = 3 }
local puffs   = perlin { frequency = 2.2, speed = 2, seed = 8 }
for side = -1, 1, 2 do
  air:source {
    shape = sphere { position = {2.6 * side, 0.1 * side, 0.9}, radius = 0.2 },
    density = smoothstep(0.3, 0.55, puffs), temperature = 1, dye = (1 + side) / 2 * smoothstep(0.3, 0.55, puffs),
    velocity = vec(-side * speed, 0, 0.25 * speed) + flutter * uneven,
  }
end

-- What is finer than a cell is not in the air. Noise stands for it, carried along by the air, and eats at
-- the smoke where that is thin.
local lumps = worley { frequency = 2.6, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.7, mean = 0.48 })
local folds = curl { frequency = 2, octaves = 3, persistence = 0.6, drift = {0, 0, -0.8}, speed = 0.6, seed = 9 }:tile()
local cover = clamp(air.density:warp(folds, folded) * 6, 0, 1)
local smoke = cover * smoothstep(0, 0.25, cover - eaten * (1 - lumps) * (1 - 0.7 * cover))
local hue   = mix(colors[1], colors[2], smoothstep(0.2, 0.8, (air.dye / air.density):warp(folds, folded)))

-- The lamp is a little gas that glows, and a light in its place.
local at   = {0, -0.15, 1.75}
local gas  = sphere { position = at, radius = 0.10, falloff = 0.10 }
local warm = {1, 0.52, 0.18}
fx.lights = {
  point_light { position = at, color = warm, power = power },
  spot_light { position = {-5, 4, 4.5}, target = {-1.5, 0, 1.2}, color = {0.35, 0.6, 1}, power = 900, angle = 60, softness = 0.6 },
  spot_light { position = {5, 4, 4.5}, target = {1.5, 0, 1.2}, color = {1, 0.25, 0.45}, power = 900, angle = 60, softness = 0.6 },
}
fx.sun    = sun { azimuth = 70, elevation = 30, color = {0.5, 0.7, 1}, strength = 0.2 }
fx.sky    = sky { zenith = {0.004, 0.007, 0.018}, horizon = {0.012, 0.016, 0.03}, strength = 1 }
fx.camera = camera { eye = {0, -10.5, 1.5}, target = {0, 0, 1.95}, fov = 30, near = 0.1, far = 500 }

local lit = lighting {
  density = smoke * density + gas, tint = hue, emission = gas * power * 0.12 * warm,
  albedo = {0.98, 0.98, 0.98}, anisotropy = 0.25, fire_lights = "0", sampling = "cubic",
}
local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit}, haze = 0.006 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.3, exposure_ev = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
