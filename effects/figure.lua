-- A runner made of smoke, in the wind: the whole body is a source, and the air tears off it what it is
-- made of. Every two seconds the runner fades, and is there again.
--
--   roil render effects/figure.lua --frames 54 -o figure.png
--   roil render effects/figure.lua --frames 54 --set wind=0.2 --set lift=3 -o ghost.png   -- it rises off the shoulders
--   roil render effects/figure.lua --frames 54 --set rest=1.04 -o burst.png                -- it is blown off on all sides
--
-- Play with `wind`, `lift`, `rest`, `uneven` (how rough the body is), `wisps` and `presence`, a curve.

local fx = effect { name = "figure", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 192 x 64 x 96; taken when the effect loads" }
local density = param { "density", 80, min = 0, max = 200, unit = "1/m", help = "how thick the body is; what it leaves is much thinner" }
local wind    = param { "wind", 3, min = 0, max = 5, unit = "m/s", help = "against which the runner runs" }
local lift    = param { "lift", 0.8, min = -5, max = 10, unit = "m/s^2", help = "how fast the smoke's heat makes it rise" }
local rest    = param { "rest", 1, min = 1, max = 1.05, help = "density at which the air in the body is held, of that around: above 1 the body blows out air; 1: as the wind has it" }
local uneven  = param { "uneven", 0.6, min = 0, max = 1, help = "how patchy what leaves the body is, and how rough its skin" }
local eaten   = param { "eaten", 0.6, min = 0, max = 2, help = "how much noise finer than a cell eats from the smoke" }
local folded  = param { "folded", 0.1, min = 0, max = 0.2, unit = "m", help = "how far eddies finer than a cell carry the smoke" }
local wisps   = param { "wisps", 0.3, min = 0, max = 1, unit = "m", help = "how far the wind draws wisps out of the body" }
local color   = param { "color", {0.92, 0.95, 1}, color = true, help = "of the smoke" }

-- How much of the runner is there, by the second; what it sheds goes on, so that the trail has no gap.
local presence = curve { {0, 1}, {1.4, 1}, {1.8, 0.3}, {2, 1}, shape = "ease_in_out", period = 2 }

-- 4.8 x 1.6 x 2.4 metres: the wind comes in on the right, and leaves where it likes. The mesh's cells are
-- the source; `rule` keeps wrists and ankles from being fattened to a whole cell.
local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(192), cells(64), cells(96)}, voxel_size = 4.8 / cells(192), position = {-1.35, 0, 0},
  boundary = { right = "inflow", left = "open", front = "open", back = "open", top = "open", bottom = "wall" },
  wind = vec(-wind, 0, 0), buoyancy_heat = lift, cooling_rate = 0.3, dissolve_rate = 0.6, speed = 4,
}
local stiffness = 1.2 * (4.8 / cells(192) / air.time_step) ^ 2 / 3 -- Pa of a density of 1 on this lattice
local runner = mesh { "data/figure.obj" }
local grain  = worley { frequency = 5, octaves = 2, speed = 1.5, drift = {-0.4, 0, 0}, seed = 4 }:tile()
air:source {
  runner, rule = "solid", temperature = 1,
  density = mix(1, smoothstep(0.3, 0.6, grain), uneven) * mix(0.35, 1, smoothstep(0.3, -0.2, position.x)),
  velocity = vec(-0.45 * wind, 0, 0) + curl { frequency = 1.5, speed = 2, seed = 6 },
  pressure = rest:get() > 1 and (rest - 1) * stiffness or nil,
}

-- What is finer than a cell is not in the air. Noise stands for it, carried along by the air, and eats at
-- the smoke where that is thin. What is hardly there is left out: no samples are taken where nothing is.
local lumps = worley { frequency = 5, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.5, mean = 0.48 })
local folds = curl { frequency = 4, octaves = 3, persistence = 0.6, drift = {1, 0, 0}, speed = 0.8, seed = 9 }:tile()
local cover = smoothstep(0.06, 0.65, air.density:warp(folds, folded))
local trail = cover * (0.3 + 1.2 * lumps * lumps) * smoothstep(0, 0.35, cover - eaten * (1 - lumps) * (1 - 0.6 * cover))

-- The body itself is sharper than cells of the air could show it: a distance to the mesh, in finer ones.
-- The same noise roughens it, by less than a wrist is thick so that nothing is lost; and where that is
-- strong the wind draws wisps out of the body, into what the air carries on: `drawn` asks for it upwind.
local body  = voxels { runner, resolution = 160 }
local near  = box { position = {-0.17, 0, 1.09}, size = {2.0, 0.85, 1.75} } -- a distance is known everywhere; the smoke ends here
local fine  = worley { frequency = 13, octaves = 2, persistence = 0.6, drift = {-0.8, 0, 0.2}, seed = 12 }:tile()
local drawn = body.distance:warp(vec(1, 0, -0.15), wisps * lumps * lumps)
local rough = 0.055 * (lumps - 0.5) + 0.04 * (fine - 0.5)
local edge  = min(body.distance, drawn + 0.055) + 0.012 - uneven * rough + 0.03 * (1 - presence) * (1 - lumps)
local skin  = near * smoothstep(0.025, -0.05, edge) * mix(0.3, 1, presence)
local left  = smoothstep(-0.02, 0.05, body.distance) -- what has left it: inside, cells of the air are not seen
local smoke = max(0.035 * trail * left, skin)

-- The sun has almost set behind the runner, and shines through what is thin; on this side it is night.
fx.sun    = sun { azimuth = 80, elevation = 15, color = {1, 0.37, 0.10}, strength = 18 }
fx.sky    = sky { zenith = {0.001, 0.004, 0.018}, horizon = {0.034, 0.066, 0.115}, strength = 1 }
fx.lights = {
  spot_light { position = {4.5, -4, 3.8}, target = {-0.5, 0, 1.1}, color = {0.15, 0.42, 1}, power = 2600, angle = 50, softness = 0.6 },
}
fx.camera = camera { eye = {-0.3, -9, 0.75}, target = {-0.5, 0, 1.15}, fov = 14, near = 0.1, far = 500 }

local lit    = lighting { density = smoke * density, albedo = {0.5, 0.56, 0.66}, tint = color, anisotropy = 0.45, shadow_resolution = 192, sampling = "cubic" }
local scene  = geometry { mesh { "data/ground.obj", color = {0.1, 0.14, 0.25} } }
local solid  = shade { from = {scene, lit}, haze = 0.03 }
local volume = march { from = {lit, scene}, steps = 160 }

local picture = over { volume, solid, from = {volume, scene} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.2, exposure_ev = 0.4, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
