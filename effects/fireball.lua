-- A ball of fire that hangs in the air and pumps like a small sun. Templates at its surface, their upper
-- edge turned outwards, throw tongues of fire away from its centre, which curl over at their ends. They
-- are small, short and strong, and nothing rises, as there is no buoyancy (Krueger and Westermann 2005,
-- section 4.2: fire ball). Six planes of 2D flow are turned round the axis.
--
--   roil render effects/fireball.lua --frames 24 -o fireball.png
--   roil render effects/fireball.lua --frames 24 --set rendering=particles -o points.png
--   roil render effects/fireball.lua --frames 24 --set corona=0 -o calm.png   -- without templates
--
-- Play with `corona`, with `slices.cooling_rate` (how far tongues reach) and `tongues.amount`.

local fx = effect { name = "fireball", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local detail     = param { "detail", 0.5, min = 0.25, max = 4, help = "cells along each edge of a slice, relative to 192 x 192; taken when the effect loads" }
local rendering  = param { "rendering", "volume", words = {"volume", "particles", "both"}, help = "how the flow is shown" }:get()
local thickness  = param { "thickness", 20, min = 0, max = 50, unit = "1/m", help = "how dense it is: how deep one sees into it" }
local corona     = param { "corona", 1, min = 0, max = 5, help = "strength of the templates at its surface" }
local brightness = param { "brightness", 64, min = 0, max = 500, unit = "1/m", help = "factor of the fire's light" }
local wobble     = param { "wobble", 0.14, min = 0, max = 1, unit = "m", help = "how far the volume is bent out of its round shape" }

-- What is turned round an axis looks turned: points are moved by a fractal offset, which boils.
local offset = curl { frequency = 1.1, octaves = 3, persistence = 0.6, speed = 0.5, seed = 5 } * wobble

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local flow = slices {
  count = 6, size = {cells(192), cells(192)}, height = 4, sides = "open", bottom = "open", offset = offset, seed = 3,
  buoyancy_heat = 0, cooling_rate = 1.2, dissolve_rate = 5, vorticity = 3, variation = 0.1, warm_up = 0.5,
  position = {0, 0, 0.4},
}

-- The ball itself: flow takes on its heat within a twentieth of a second. Its air is held at rest, or
-- tongues, which push as hard back as out, would soon drive it away.
flow:inflow { shape = disc { 0.5, 0.5, radius = 0.21, falloff = 0.06 }, density = 1, temperature = 1, velocity = {0, 0}, rate = 20 }

-- The corona, on a ring at the surface of every slice: raised pressure makes it swell here and there,
-- jets shoot out of it.
local surface = disc { 0.5, 0.5, radius = 0.27 } * (1 - disc { 0.5, 0.5, radius = 0.2 })
flow:templates {
  image "templates/jet.exr", name = "swellings", kind = "pressure", align = "radial", strength = 30 * corona,
  count = 12, size = {0.06, 0.14}, lifetime = {0.08, 0.2}, spread = 25, region = surface,
}
flow:templates {
  image "templates/jet.exr", name = "tongues", kind = "velocity", align = "radial", strength = 360 * corona,
  count = 6, size = {0.14, 0.24}, lifetime = {0.08, 0.2}, spread = 25, region = surface,
}

-- One sample for all that is shown: the offset is evaluated once for each of these voxels.
local heat = bake(flow.temperature, { size = {cells(192), cells(192), cells(192)} })

-- Between two slices tongues are as wide as the angle there. Noise that is looked up by the direction
-- from the middle tears them into strands, more so further out, along which it moves outwards.
local away    = position - vec(0, 0, 2.4)
local radius  = length(away)
local strands = worley { frequency = 4, octaves = 2, persistence = 0.6, drift = {0, 0, -1.5}, seed = 11 }
                :warp(away / max(radius, 0.1) + vec(0, 0, 0.5) * radius - position)
local torn    = heat - 0.2 * (1 - strands) * smoothstep(0.7, 1.5, radius)

-- Grains as on the sun: bright cells, and dark where they meet.
local grains = worley { frequency = 3.2, octaves = 3, persistence = 0.55, speed = 0.8, distance = "f2_f1", seed = 11 }
local hot    = torn * (0.32 + 1.35 * grains)
local fire   = palette {
  {0.08, {0, 0, 0}}, {0.24, {0.15, 0.011, 0.0005}}, {0.44, {0.9, 0.15, 0.01}}, {0.8, {2.4, 0.85, 0.12}}, {1.1, {6, 3.9, 1.5}},
}

fx.camera = camera { eye = {0, -8.2, 1.5}, target = {0, 0, 2.1}, fov = 32, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239, elevation = 34, color = {0.6, 0.7, 1}, strength = 0.05 }
fx.sky    = sky { zenith = {0.002, 0.004, 0.010}, horizon = {0.008, 0.009, 0.016} }

-- Only what is hot hides what is behind it: tongues are mere light, while the ball has a surface. One
-- sees into it deeper from the front than at its limb, which is why that is cooler.
local lit   = lighting {
  density = heat * smoothstep(0.1, 0.6, torn) * thickness, emission = heat * fire(hot) * brightness,
  albedo = {0.1, 0.1, 0.1}, sampling = "linear", glow_resolution = 16,
}
local scene = geometry { mesh { "data/ground.obj", color = {2, 1.9, 1.8} } }
local solid = shade { from = {scene, lit} }

local picture = solid
if rendering ~= "particles" then
  local volume = march { from = {lit, scene}, steps = 128, jitter = 0.5 }
  picture = over { volume, picture, from = {volume, scene} }
end
if rendering ~= "volume" then
  -- They are born wherever the surface and its tongues are hot, and die soon: what is turned from
  -- planes does not keep its volume, and would sweep them together.
  local sparks = particles {
    count = 108032, rate = 180000, lifetime = {0.1, 0.6}, seed = 8, warm_up = 0.6, above = {heat * smoothstep(0.4, 0.7, radius), 0.18},
    velocity = flow.velocity, quantity = hot,
  }
  local drawn = splats {
    from = {sparks, scene, lit}, density = 0.4 * heat * smoothstep(0.4, 0.9, heat) * thickness, size = over_age { {0, 0.08}, {1, 0.05} }, streak = 0.05,
    color = fire(0.1 + particle_quantity).rgb, brightness = (rendering == "both" and 0.004 or 0.011) * brightness,
  }
  picture = over { drawn, picture, from = {drawn, scene} }
end

local halo  = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown = final { source = picture, bloom = halo, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
