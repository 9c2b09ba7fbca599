-- A cube of smoke between two lamps. The air is still, and a cube of it is full of smoke: light gets a
-- little way into it from either side, and between the two it is dark. After a while the cube is let go:
-- its smoke is heavy, sinks together and rolls over the ground to both lamps.
--
--   roil render effects/cube.lua --frames 20 -o cube.png
--   roil render effects/cube.lua --frames 60 -o fallen.png
--   roil render effects/cube.lua --frames 60 --set weight=-1.5 -o risen.png
--
-- Play with `density` (how far light gets), `weight` and `hold`, with the colours of the lamps and with
-- how far they stand apart.

local fx = effect { name = "cube", fps = 24, frames = 144, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 128 x 96 x 64; taken when the effect loads" }
local density = param { "density", 9, min = 0, max = 50, unit = "1/m", help = "how thick the smoke is" }
local weight  = param { "weight", 2.2, min = -5, max = 5, unit = "m/s^2", help = "how fast the smoke's own weight makes it fall; below 0 it rises" }
local hold    = param { "hold", 1, min = 0, max = 5, unit = "s", help = "how long the cube is held" }
local edge    = param { "edge", 1.5, min = 0.4, max = 2, unit = "m", help = "of the cube" }
local eaten   = param { "eaten", 0.9, min = 0, max = 2, help = "how much noise finer than a cell eats from smoke that is thin" }
local apart   = param { "apart", 3.0, min = 2, max = 6, unit = "m", help = "between the two lamps" }
local power   = param { "power", 220, min = 0, max = 5000, unit = "W", help = "of each lamp" }
local colors  = { param { "left", {1, 0.36, 0.07}, color = true, help = "of the left lamp" },
                  param { "right", {0.07, 0.3, 1}, color = true, help = "of the right lamp" } }

-- 6.4 x 4.8 x 3.2 metres of air on the ground.
local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(128), cells(96), cells(64)}, voxel_size = 6.4 / cells(128),
  boundary = { bottom = "wall", sides = "open", top = "open" },
  buoyancy_density = -weight, dissolve_rate = 0.05, speed = 4,
}

-- As long as it is held the cube is a source: smoke, and air that does not move. Noise makes its smoke
-- uneven, or it would fall as evenly as a piston.
local middle  = {0, 0, 1.35}
local grain   = perlin { frequency = 2.2, octaves = 2, seed = 8 }
air:source {
  shape = box { position = middle, size = vec(edge, edge, edge) } * step(time, hold),
  density = 0.7 + 0.6 * grain, velocity = {0, 0, 0},
}

-- What is finer than a cell is not in the air. Noise stands for it, carried along by the air, and eats at
-- the smoke where that is thin.
local lumps = worley { frequency = 2.6, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.7, mean = 0.48 })
local folds = curl { frequency = 2, octaves = 3, persistence = 0.6, seed = 9 }:tile()
local free  = smoothstep(hold, hold + 0.7, time) -- a cube that is held has edges
local loose = clamp(air.density:warp(folds, 0.07 * free), 0, 1)
local cover = mix(smoothstep(0.3, 0.7, loose), loose, free)
local smoke = cover * mix(0.55, 1.35, lumps) * smoothstep(0, 0.3, cover - eaten * free * (1 - lumps) * (1 - 0.7 * cover))

-- Each lamp is a little gas that glows, and a light in its place.
local gas, glow, lamps = 0, vec(0, 0, 0), {}
for i, side in ipairs { -1, 1 } do
  local at = function() return {side * apart:get() / 2, -0.25, 1.5} end
  local ball = sphere { position = at, radius = 0.09, falloff = 0.09 }
  gas, glow = gas + ball, glow + ball * power * 0.2 * colors[i]
  lamps[i] = point_light { position = at, color = colors[i], power = power }
end
fx.lights = lamps
fx.sun    = sun { azimuth = 70, elevation = 30, color = {0.5, 0.7, 1}, strength = 0.05 }
fx.sky    = sky { zenith = {0.003, 0.004, 0.008}, horizon = {0.008, 0.009, 0.013}, strength = 1 }
fx.camera = camera { eye = {0.9, -8, 2.3}, target = {0, 0, 1.1}, fov = 30, near = 0.1, far = 500 }

local lit = lighting {
  density = smoke * density + gas * 4, emission = glow, albedo = {0.88, 0.88, 0.88}, anisotropy = 0.1,
  fire_lights = "0", sampling = "cubic",
}
local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit}, haze = 0.006 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local halo    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = halo, bloom_intensity = 0.3, exposure_ev = 0.5, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
