-- The smoke of a cigarette: a straight thread, which breaks into whirls of all sizes where it has cooled.
-- Heat is given off all the time at the tip, and what flows out above is let out. The thread is left
-- alone; above, templates stir it which are small and short, so that no large vortex comes of them,
-- and as strong as it is warm (Krueger and Westermann 2005, section 4.2: smoke).
--
--   roil render effects/cigarette.lua --frames 48 --size 360x480 -o smoke.png
--   roil render effects/cigarette.lua --frames 48 --size 360x480 --set rendering=particles -o points.png
--   roil render effects/cigarette.lua --frames 48 --size 360x480 --set stir=0 -o calm.png   -- without templates
--
-- Play with `stir`, `heat` (how fast it rises) and `slices.reynolds` (low: syrup).

local fx = effect { name = "cigarette", fps = 24, frames = 192, author = "the roil authors", licence = "MIT" }

local detail    = param { "detail", 0.5, min = 0.25, max = 4, help = "cells along each edge of a slice, relative to 256 x 512; taken when the effect loads" }
local rendering = param { "rendering", "volume", words = {"volume", "particles", "both"}, help = "how the flow is shown" }:get()
local thickness = param { "thickness", 90, min = 0, max = 500, unit = "1/m", help = "how dense the smoke is" }
local heat      = param { "heat", 1, min = 0, max = 4, help = "temperature of the ember" }
local stir      = param { "stir", 1, min = 0, max = 10, help = "strength of the templates, which break the thread" }
local wobble    = param { "wobble", 0.02, min = 0, max = 0.2, unit = "m", help = "how far the upper smoke is bent out of its round shape" }

-- What is turned round an axis looks turned: points are moved by a fractal offset, but for the thread,
-- which stays straight.
local rise   = smoothstep(0.12, 0.4, position.z)
local offset = curl { frequency = 7, octaves = 3, persistence = 0.6, seed = 5 }:tile() * wobble * rise

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local flow = slices {
  count = 2, size = {cells(256), cells(512)}, height = 0.5, sides = "open", offset = offset, seed = 3, warm_up = 3,
  buoyancy_heat = 2.2, cooling_rate = 0.8, dissolve_rate = 0.1, vorticity = 2, variation = 0.1, reynolds = 4000, speed = 0.4,
}
flow:inflow { shape = disc { 0.5, 0.03, radius = 0.014, falloff = 0.008 }, density = 1, temperature = heat, velocity = {0, 0.15} }
for _, sense in ipairs { "left", "right" } do
  flow:templates {
    image("templates/vortex_" .. sense .. ".exr"), kind = "velocity", strength = 12 * stir, scale_by = "temperature",
    within = "density", above = 0.05, count = 20, size = {0.04, 0.16}, lifetime = {0.03, 0.15},
    region = box { position = {0.5, 1.4, 0}, size = {1, 1.4, 1}, falloff = 0.2 },
  }
end

-- What spreads in a plane gets thinner only to its sides; in space it would all round. The share of
-- a ring round the axis makes up for it.
local around = bake(flow.density, { size = {cells(256), cells(256), cells(512)}, box = flow.box })
local smoke  = around / (1 + length(vec(position.x, position.y, 0)) * 60)

fx.camera = camera { eye = {0.1, -1.05, 0.2}, target = {0, 0, 0.2}, fov = 26, near = 0.01, far = 50 }
fx.sun    = sun { azimuth = 30, elevation = 25, color = {0.85, 0.92, 1}, strength = 11 }
fx.sky    = sky { zenith = {0.004, 0.005, 0.008}, horizon = {0.006, 0.007, 0.010}, strength = 1 }
fx.lights = { sphere_light { position = {0.002, 0, 0.001}, radius = 0.004, color = {1, 0.25, 0.05}, power = 0.01 } }

-- Lit from behind, as smoke is seen best: it throws light on rather than back.
local lit     = lighting {
  density = smoke * thickness, albedo = {0.97, 0.97, 0.98}, anisotropy = 0.6,
  shadow_resolution = 64, sampling = "linear",
}
local scene   = geometry { mesh { "data/cigarette.obj" } }
local picture = shade { from = {scene, lit} }
if rendering ~= "particles" then
  local volume = march { from = {lit, scene}, steps = 160, jitter = 0.5 }
  picture = over { volume, picture, from = {volume, scene} }
end
if rendering ~= "volume" then
  -- Particles of smoke do not spread as what is in cells does: threads stay as fine as they were.
  local threads = particles {
    count = 131072, rate = 36000, lifetime = {2.6, 3.6}, seed = 8, warm_up = 3, position = {0.002, 0, 0.006}, radius = 0.0035,
    velocity = flow.velocity + curl { frequency = 45, octaves = 2, speed = 1.5, seed = 2 } * 0.03 * rise,
  }
  local drawn = splats {
    from = {threads, scene, lit}, size = over_age { {0, 0.0016}, {1, 0.003} }, color = {0.95, 0.96, 1},
    opacity = over_age { {0, 0.25}, {0.7, 0.12}, {1, 0} }, blend = "weighted", weight_distance = 1, lit = "on", anisotropy = 0.6, view_steps = 0,
  }
  picture = over { drawn, picture, from = {drawn, scene} }
end

local shown = final { source = picture, tonemap = "agx" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
