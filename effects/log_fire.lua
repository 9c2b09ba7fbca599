-- A log fire at night: flames lick up between the logs, tear off and become smoke. Four planes of 2D
-- flow are turned round the axis; heat is given off below all the time, many small templates stir
-- it there, larger ones above, where fire becomes smoke. All of them are as strong as it is hot
-- where they are (Krueger and Westermann 2005, section 4.2). The fire lights what stands around.
--
--   roil render effects/log_fire.lua --frames 72 -o fire.png
--   roil render effects/log_fire.lua --frames 72 --set rendering=particles -o points.png
--   roil render effects/log_fire.lua --frames 72 --set licks=0 --set billows=0 -o calm.png   -- without templates
--
-- Play with `heat` (how high it burns), `licks` and `billows`, and `slices.cooling_rate`.

local fx = effect { name = "log_fire", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail     = param { "detail", 0.5, min = 0.25, max = 4, help = "cells along each edge of a slice, relative to 128 x 256; taken when the effect loads" }
local rendering  = param { "rendering", "volume", words = {"volume", "particles", "both"}, help = "how the flow is shown" }:get()
local heat       = param { "heat", 1, min = 0, max = 3, help = "that the logs give off: how high it burns" }
local licks      = param { "licks", 1, min = 0, max = 10, help = "strength of the small templates among the logs" }
local billows    = param { "billows", 1, min = 0, max = 10, help = "strength of the large ones above" }
local thickness  = param { "thickness", 0.5, min = 0, max = 20, unit = "1/m", help = "how dense the smoke is" }
local brightness = param { "brightness", 70, min = 0, max = 200, help = "factor of the flames' light" }
local embers     = param { "embers", 90, min = 0, max = 2000, unit = "1/s", help = "that fly up" }
local wobble     = param { "wobble", 0.1, min = 0, max = 1, unit = "m", help = "how far the volume is bent out of its round shape" }

-- What is turned round an axis looks turned. Points are moved by a fractal offset before they are
-- looked up in the slices; it rises as the flames do.
local offset = curl { frequency = 1.8, octaves = 3, persistence = 0.6, drift = {0, 0, -1.6}, seed = 5 } * wobble

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local flow = slices {
  count = 4, size = {cells(128), cells(256)}, height = 3.6, position = {0, 0, 0.02}, sides = "open", offset = offset, seed = 3,
  buoyancy_heat = 7, cooling_rate = 1.3, dissolve_rate = 0.6, vorticity = 2, variation = 0.25, warm_up = 3,
}

-- The bed glows unevenly: here and there, and now and then.
local flicker = perlin { frequency = 9, octaves = 2, speed = 2.5, seed = 6 }
flow:inflow {
  shape = box { position = {0.5, 0.05, 0}, size = {0.34, 0.08, 1} }, rate = 14,
  density = 0.8, temperature = heat * (0.5 + 1.1 * smoothstep(0.3, 0.6, flicker)),
}
flow:templates {
  image "templates/corona.exr", name = "licks", kind = "pressure", strength = 0.12 * licks, scale_by = "temperature", align = "fixed", spread = 40,
  count = 48, size = {0.03, 0.09}, lifetime = {0.04, 0.15}, region = box { position = {0.5, 0.18, 0}, size = {0.5, 0.3, 1} },
  within = "temperature", above = 0.1,
}
for _, sense in ipairs { "left", "right" } do
  flow:templates {
    image("templates/vortex_" .. sense .. ".exr"), kind = "velocity", strength = 3.5 * billows, scale_by = "temperature",
    count = 10, size = {0.2, 0.5}, lifetime = {0.15, 0.5}, region = box { position = {0.5, 1.3, 0}, size = {0.7, 1.4, 1} },
    within = "density", above = 0.05,
  }
end

-- One sample for all that is shown: the offset is evaluated once for each of these voxels. Noise makes
-- ragged what is finer than they are. It is asked at points that are pressed together in height, which
-- draws it out upwards, as flames are.
local turned = bake(vec(flow.density, flow.temperature, 0), { size = {cells(128), cells(128), cells(256)} })
local ragged = worley { frequency = 5, octaves = 3, persistence = 0.55, drift = {0, 0, -1}, speed = 0.6, seed = 11 }:warp(vec(0, 0, -0.6 * position.z), 1)

-- All is gone where the slices end (at 0.9 m) and where there is hardly any soot, so that their edge is not
-- seen: smoke by its density, flames by their heat, which keeps the round form of a flame that ends there.
local away   = 1 - smoothstep(0.45, 0.85, length(vec(position.x, position.y, 0)))
local soot   = smoothstep(0.04, 0.2, turned.x)
local hot    = turned.y * (0.5 + 1.1 * smoothstep(0.3, 0.8, ragged)) * away * sqrt(soot)

-- Flames are thin, and hide nothing: soot that glows, the hotter the brighter.
local glow  = palette { {0.15, {0, 0, 0}}, {0.3, {0.16, 0.025, 0.002}}, {0.5, {1, 0.22, 0.02}}, {0.8, {1.6, 0.52, 0.06}}, {1.2, {2, 0.9, 0.16}} }
local flame = glow(hot).rgb

fx.camera = camera { eye = {0.6, -4.6, 0.85}, target = {0, 0, 0.82}, fov = 27, near = 0.05, far = 500 }
fx.sun    = sun { azimuth = 60, elevation = 40, color = {0.55, 0.7, 1}, strength = 0.04 } -- the moon
fx.sky    = sky { zenith = {0.003, 0.005, 0.012}, horizon = {0.010, 0.012, 0.020} }

local lit = lighting {
  density = turned.x * away * soot * thickness, emission = flame * brightness,
  albedo = {0.5, 0.48, 0.46}, anisotropy = 0.3, sampling = "linear",
}
local scene  = geometry { mesh { "data/ground.obj", color = {1.8, 1.7, 1.6} }, mesh { "data/logs.obj" } }
local solid  = shade { from = {scene, lit}, shadow_samples = 2 }

-- Embers go where the air goes.
local wind   = curl { frequency = 1.5, speed = 0.6, seed = 9 } * 0.5
local chips  = particles {
  name = "embers", count = 2048, rate = embers, lifetime = {0.6, 2.6}, seed = 4, position = {0, 0, 0.3}, radius = 0.25,
  velocity = clamp(flow.velocity, -3, 3) + wind + {0, 0, 0.5},
}
local sparks = splats {
  name = "sparks", from = {chips, scene, lit}, size = over_age { {0, 0.008}, {1, 0.004} },
  color = over_age { {0, {1, 0.40, 0.07}}, {0.6, {1, 0.16, 0.02}}, {1, {0.1, 0.01, 0}} }, brightness = 40, streak = 0.02,
}

local picture = solid
if rendering ~= "particles" then
  -- An eye sees both the flames orange and the ground that they light, which a display cannot show: it
  -- would show white flames. So the picture gets a fifth of the light that the ground gets.
  local volume = march { from = {lit, scene}, emission = flame * brightness * 0.2, steps = 128, jitter = 0.5 }
  picture = over { volume, picture, from = {volume, scene} }
end
if rendering ~= "volume" then
  local carried = particles {
    name = "soot", count = 65536, rate = 26000, lifetime = {0.5, 2.2}, seed = 8, warm_up = 1,
    shape = box { position = {0, 0, 0.14}, size = {0.7, 0.7, 0.2} }, velocity = flow.velocity, quantity = flow.temperature,
  }
  local drawn = splats {
    name = "flames", from = {carried, scene, lit}, size = over_age { {0, 0.05}, {1, 0.12} },
    color = glow(particle_quantity).rgb, brightness = 0.16, soften = 0.05,
  }
  picture = over { drawn, picture, from = {drawn, scene} }
end
picture = over { sparks, picture, from = {sparks, scene} }

local halo  = bloom { bright { picture, threshold = 1 }, radius = 0.75 }
local shown = final { source = picture, bloom = halo, bloom_intensity = 0.25, exposure_ev = 0.6, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
