-- Coloured smoke in a white studio: five nozzles puff at each other, and wind stirs it. The air carries
-- two things, smoke and a dye, and a palette makes a colour of their ratio: it is 0 in the first nozzle's
-- smoke, 1 in the last one's, and between them where they have mixed.
--
--   roil render effects/dye.lua --frames 84 -o dye.png
--   roil render effects/dye.lua --frames 84 --set swirl=0 -o fountain.png
--
-- Play with `inks`, the palette (in `roil live` its stops can be dragged), `swirl`, `speed` and `folded`.

local fx = effect { name = "dye", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 96 x 96 x 96; taken when the effect loads" }
local density = param { "density", 14, min = 0, max = 50, unit = "1/m", help = "how thick the smoke is" }
local speed   = param { "speed", 3.4, min = 0, max = 5, unit = "m/s", help = "of the puffs" }
local swirl   = param { "swirl", 0.6, min = -2, max = 2, help = "how much they blow around the middle, against upwards" }
local eaten   = param { "eaten", 1.4, min = 0, max = 2, help = "how much noise finer than a cell eats from the smoke" }
local folded  = param { "folded", 0.09, min = 0, max = 0.3, unit = "m", help = "how far eddies finer than a cell carry the smoke" }
local inks    = palette { {0, "#3cbcf0"}, {0.25, "#6a68ee"}, {0.5, "#ec58b4"}, {0.75, "#ff7a40"}, {1, "#ffc93c"} }

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(96), cells(96), cells(96)}, voxel_size = 4.2 / cells(96),
  boundary = { bottom = "wall", sides = "open", top = "open" },
  buoyancy_heat = 0.9, cooling_rate = 0.25, dissolve_rate = 0.06, speed = 4,
  force = curl { frequency = 0.9, octaves = 3, speed = 0.8, seed = 5 } * 3,
}

-- Where a source is, the air has what is said here, also nothing at all: between puffs a nozzle is still.
local nozzles = 5
local flutter = curl { frequency = 1.6, speed = 2, octaves = 2, seed = 3 }
for i = 1, nozzles do
  local angle = 2 * math.pi * (i - 0.75) / nozzles
  local x, y  = math.cos(angle), math.sin(angle)
  local ink   = (i - 1) / (nozzles - 1)
  local puff  = smoothstep(-1, -0.2, sin(3.6 * time + 2 * math.pi * ((2 * i) % nozzles) / nozzles))
  air:source {
    shape = sphere { position = {x, y, 0.3}, radius = 0.18 },
    density = puff, dye = ink * puff, temperature = puff,
    velocity = (vec(-0.75 * x - swirl * y, -0.75 * y + swirl * x, 1) + 0.3 * flutter) * speed * puff,
  }
end

-- What is finer than a cell is not in the air. Noise stands for it: eddies fold what the air holds, and
-- lumps, carried along by the air, eat at the smoke where that is thin.
local lumps = worley { frequency = 3, octaves = 3, persistence = 0.55, lacunarity = 2.1, seed = 4 }
              :tile():advect(air.velocity, { period = 0.5, mean = 0.48 })
local folds = curl { frequency = 2.2, octaves = 3, persistence = 0.6, drift = {0, 0, -1.2}, speed = 0.6, seed = 9 }:tile()
local cover = clamp(air.density:warp(folds, folded) * 3, 0, 1)
local hue   = (air.dye / air.density):warp(folds, folded)
local smoke = cover * smoothstep(0, 0.3, cover - eaten * (1 - lumps) * (1 - 0.55 * cover))

fx.camera = camera { eye = {0, -9.5, 2.3}, target = {0, 0, 1.45}, fov = 23, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 250, elevation = 48, color = {1, 0.97, 0.93}, strength = 4.6 }
fx.sky    = sky { zenith = {0.70, 0.74, 0.80}, horizon = {0.92, 0.92, 0.92}, strength = 1 }

local lit = lighting {
  density = smoke * density, tint = inks(clamp(hue, 0, 1)),
  albedo = {0.98, 0.98, 0.98}, anisotropy = 0.1, sampling = "cubic",
}
local scene  = geometry { mesh { "data/ground.obj", color = {5, 5.6, 6.5} } }
local solid  = shade { from = {scene, lit}, haze = 0.05 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, exposure_ev = 0.2, tonemap = "aces", saturation = 1.1 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
