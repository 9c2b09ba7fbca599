-- A ball of fire that hangs in the air and pumps like a small sun: templates of raised pressure at its
-- surface, their upper edge turned outwards, throw tongues of fire away from its centre. They are
-- small, short and strong, and nothing rises, as there is no buoyancy (Krueger and Westermann 2005,
-- section 4.2: fire ball). Four planes of 2D flow are turned round the axis.
--
--   roil render effects/fireball.lua --frames 24 -o fireball.png
--   roil render effects/fireball.lua --frames 24 --set rendering=particles -o points.png
--   roil render effects/fireball.lua --frames 24 --set corona=0 -o calm.png   -- without templates
--
-- Play with `corona`, with `slices.cooling_rate` (how far tongues reach) and `slices_templates.amount`.

local fx = effect { name = "fireball", fps = 24, frames = 96 }

local detail     = param { "detail", 0.5, min = 0.25, max = 4, help = "cells along each edge of a slice, relative to 192 x 192; taken when the effect loads" }
local rendering  = param { "rendering", "volume", words = {"volume", "particles", "both"}, help = "how the flow is shown" }:get()
local thickness  = param { "thickness", 8, min = 0, max = 50, unit = "1/m", help = "how dense it is" }
local corona     = param { "corona", 1, min = 0, max = 5, help = "strength of the templates at its surface" }
local brightness = param { "brightness", 8, min = 0, max = 50, help = "factor of the fire's light" }
local wobble     = param { "wobble", 0.12, min = 0, max = 1, unit = "m", help = "how far the volume is bent out of its round shape" }

-- What is turned round an axis looks turned: points are moved by a fractal offset, which boils.
local offset = curl { frequency = 1.1, octaves = 3, persistence = 0.6, speed = 0.5, seed = 5 } * wobble

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local flow = slices {
  count = 4, size = {cells(192), cells(192)}, height = 4, sides = "open", bottom = "open", offset = offset, seed = 3,
  buoyancy_heat = 0, cooling_rate = 4.5, dissolve_rate = 5, vorticity = 3, variation = 0.1, warm_up = 0.5,
  position = {0, 0, 0.4},
}

-- The ball itself: flow takes on its heat within a twentieth of a second.
flow:inflow { shape = disc { 0.5, 0.5, radius = 0.22, falloff = 0.03 }, density = 1, temperature = 1, rate = 20 }
-- The corona: 48 templates in all, put on a ring at the surface.
flow:templates {
  image "templates/corona.exr", kind = "pressure", align = "radial", strength = 50 * corona,
  count = 12, size = {0.1, 0.26}, lifetime = {0.08, 0.2}, spread = 25,
  region = disc { 0.5, 0.5, radius = 0.26 } * (1 - disc { 0.5, 0.5, radius = 0.2 }), blend = 0.05,
}

-- One sample for all that is shown: the offset is evaluated once for each of these voxels. Noise makes
-- grains as on the sun.
local size   = {cells(160), cells(160), cells(160)}
local turned = bake(vec(flow.density, flow.temperature, 0), { size = size })
local grain  = worley { frequency = 2.4, octaves = 3, persistence = 0.6, speed = 0.8, seed = 11 }
local hot    = turned.y * (0.62 + 0.6 * grain)
local fire   = palette { {0.14, {0, 0, 0}}, {0.26, {0.2, 0.02, 0.001}}, {0.5, {1.2, 0.3, 0.03}}, {0.85, {2.2, 0.95, 0.2}}, {1.2, {3, 2, 0.8}} }

fx.camera = camera { eye = {0, -8.2, 1.5}, target = {0, 0, 2.1}, fov = 32, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239, elevation = 34, color = {0.6, 0.7, 1}, strength = 0.05 }
fx.sky    = sky { zenith = {0.002, 0.004, 0.010}, horizon = {0.008, 0.009, 0.016} }

-- What the corona blows away is thin, and not shown.
local lit   = lighting {
  density = turned.x * smoothstep(0.1, 0.4, turned.x) * thickness, emission = fire(hot) * brightness,
  albedo = {0.3, 0.3, 0.3}, sampling = "linear",
}
local scene = geometry { mesh { "data/ground.obj", color = {2, 1.9, 1.8} } }
local solid = shade { from = {scene, lit} }

local picture = solid
if rendering ~= "particles" then
  local volume = march { from = {lit, scene}, steps = 128, jitter = 0.5 }
  picture = over { volume, picture, from = {volume, scene} }
end
if rendering ~= "volume" then
  local sparks = particles {
    count = 65536, rate = 60000, lifetime = {0.3, 1}, seed = 8, warm_up = 1, position = {0, 0, 2.4}, radius = 0.9,
    velocity = flow.velocity, quantity = hot,
  }
  local drawn = splats {
    from = {sparks, scene, lit}, size = over_age { {0, 0.03}, {1, 0.06} }, color = fire(particle_quantity).rgb, brightness = 1.2,
  }
  picture = over { drawn, picture, from = {drawn, scene} }
end

local halo  = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown = final { source = picture, bloom = halo, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
