-- A cumulus grows late on a summer afternoon, in time-lapse: bubbles of warm air rise from a field, and where
-- they are high enough to cool to their dew point, the water in them shows. So what is simulated is
-- vapour, and the cloud is what of it is above that height. A metre here is a hundred outside.
--
--   roil render effects/cumulus.lua --frames 108 -o cumulus.png
--   roil render effects/cumulus.lua --frames 108 --set base=1 --set wind=0.6 -o low.png
--
-- Play with `lift` (a gentle day or a thunderstorm), `base` (moist air has low clouds), `width` and `wind`.

local fx = effect { name = "cumulus", fps = 24, frames = 132, author = "the roil authors", licence = "MIT" }

local detail  = param { "detail", 0.5, min = 0.25, max = 2, help = "cells along each edge, relative to 128 x 128 x 96; taken when the effect loads" }
local density = param { "density", 40, min = 0, max = 100, unit = "1/m", help = "of the cloud" }
local lift    = param { "lift", 3.8, min = 0, max = 10, unit = "m/s^2", help = "how fast warm air rises" }
local base    = param { "base", 1.6, min = 0, max = 8, unit = "m", help = "height at which vapour becomes a cloud" }
local wind    = param { "wind", 0.2, min = 0, max = 2, unit = "m/s", help = "from the left" }
local width   = param { "width", 2.6, min = 0.2, max = 3, unit = "m", help = "of the warm field, half of it" }
local eaten   = param { "eaten", 1.5, min = 0, max = 2, help = "how much the noise eats from the edges" }
local folded  = param { "folded", 0.16, min = 0, max = 0.5, unit = "m", help = "how far eddies finer than a cell carry the cloud" }

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local air = lbm {
  size = {cells(128), cells(128), cells(96)}, voxel_size = 9.6 / cells(128),
  boundary = { bottom = "wall", sides = "open", top = "open" },
  buoyancy_heat = lift, cooling_rate = 0.5, dissolve_rate = 0.2, wind = vec(wind, 0, 0), speed = 4,
}

-- Thermals: bubbles of warm, moist air that leave the field here and there, one after the other. Each
-- place warms its air for a second of three, until evening; meanwhile it lets the wind pass (`rate`).
local day = smoothstep(4.8, 3.4, time)
for i = 1, 9 do
  local angle, far = 2.4 * i, 0.33 * width * math.sqrt(i)
  local beat = smoothstep(0.3, 0.8, sin(2.1 * time + 2.1 * i)) * day
  air:source {
    shape = sphere { position = vec(far * math.cos(angle) - 0.5, far * math.sin(angle), 0.75), radius = 0.65 },
    density = 1, temperature = 1, rate = 0.001 + 10 * beat,
  }
end

-- What is finer than a cell is not in the air. Noise stands for it, carried along by the air, and eats at
-- the cloud where that is thin. The base is not cut off at one height: air that has come from elsewhere
-- has another dew point, so the folds lift and lower it, and the cloud thins out towards it.
local lumps = worley { frequency = 1.1, octaves = 4, persistence = 0.55, lacunarity = 2.2, seed = 4 }
              :tile():advect(air.velocity, { period = 1.2, mean = 0.48 })
local folds = curl { frequency = 0.9, octaves = 4, persistence = 0.6, drift = {0, 0, -0.4}, speed = 0.4, seed = 9 }:tile()
local wet   = smoothstep(base - 0.25, base + 0.65, position.z + 0.25 * folds.z)
local body  = clamp(air.density:warp(folds, folded) * 3, 0, 1) * wet
local cloud = body * smoothstep(0, 0.2, body - eaten * (1 - lumps) * (1 - 0.6 * body))

fx.sun    = sun { azimuth = 160, elevation = 26, color = {1, 0.80, 0.55}, strength = 20 }
fx.sky    = sky { zenith = {0.03, 0.13, 0.5}, horizon = {0.40, 0.52, 0.68}, strength = 0.65 }
fx.camera = camera { eye = {0, -18, 0.5}, target = {0.1, 0, 2.9}, fov = 18, near = 0.1, far = 2000 }

local lit = lighting {
  density = cloud * density, albedo = {0.998, 0.998, 0.998}, lobes = { {0.75, 0.7}, {0.25, -0.15} },
}
local scene  = geometry { mesh { "data/ground.obj", color = {0.35, 0.5, 0.22} } }
local solid  = shade { from = {scene, lit}, haze = 0.008 }
local volume = march { from = {lit, scene}, steps = 224 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "aces", exposure_ev = 0.1 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
