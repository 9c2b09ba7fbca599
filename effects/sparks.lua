-- Sparks of a grinder: thousands of glowing chips fly off the edge of a steel box, fall, bounce off the
-- floor and off what stands there, and burn out. Nothing here is a volume: `particles` moves points,
-- `splats` draws them.
--
--   roil render effects/sparks.lua --frames 30 -o sparks.png
--   roil render effects/sparks.lua --frames 30 --set streak=0.1 --set speed=9 -o long.png
--
-- Play with `rate`, `speed` and `spread`, with `streak`, which is how long the shutter stays open, and
-- with `bounce`.

local fx = effect { name = "sparks", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local rate   = param { "rate", 9000, min = 0, max = 40000, unit = "1/s", help = "sparks that fly off" }
local speed  = param { "speed", 5.5, min = 0, max = 20, unit = "m/s", help = "of the fastest" }
local spread = param { "spread", 20, min = 0, max = 90, help = "degrees by which they leave the jet at most" }
local streak = param { "streak", 0.03, min = 0, max = 0.2, unit = "s", help = "how long a spark is seen along its way" }
local bounce = param { "bounce", 0.45, min = 0, max = 1, help = "speed that is left after they hit something" }
local kelvin = param { "kelvin", 2300, min = 1000, max = 4000, unit = "K", help = "of a spark that has just come off" }

-- The disc touches the edge here, in bursts: a hand presses it down and lets go again.
local contact  = {0.02, 0, 1.04}
local pressure = smoothstep(-0.75, 0.1, sin(2.1 * time + 0.6)) * (0.75 + 0.25 * sin(31 * time))

-- Chips of steel are heavy for their size, but the small ones are slowed by the air all the same. They
-- meet what a field says the distance to: the floor, and the boxes as voxels know them.
local boxes = mesh { "data/crates.obj", position = {-2.66, -2.32, 0} }
local body   = voxels { boxes, resolution = 48 }
local solids = min(position.z, body.distance)

local sparks = particles {
  count = 32768, rate = rate * pressure, lifetime = {0.3, 1.9}, seed = 4,
  position = contact, radius = 0.02,
  speed = vec(1, -0.2, 0.25) * speed, spread = spread, variation = 0.7,
  gravity = 9.81, drag = 0.5,
  collide = solids, clearance = 0.004, bounce = bounce, friction = 0.25,
}

-- A spark cools as it flies: its colour is that of a black body. Small ones are fainter than a pixel is
-- wide, and still give all their light.
local glow = palette { blackbody = {700, 4000}, physical = true, reference = 1700 }
local heat = kelvin * (1 - 0.55 * particle_age) * (0.85 + 0.3 * particle_random)

fx.camera = camera { eye = {1.2, -5.6, 1.3}, target = {1.35, 0, 0.7}, fov = 36, near = 0.05, far = 500 }
fx.sun    = sun { azimuth = 140, elevation = 24, color = {0.6, 0.72, 1}, strength = 0.25 }
fx.sky    = sky { zenith = {0.004, 0.006, 0.010}, horizon = {0.006, 0.007, 0.009} }
fx.lights = { -- where they come off, and the heap of them in the air
  point_light { position = {0.15, -0.1, 1.2}, color = {1, 0.62, 0.28}, power = 150 * pressure },
  point_light { position = {0.9, -0.1, 0.7}, color = {1, 0.5, 0.18}, power = 40 * pressure },
}

local scene = geometry {
  mesh { "data/ground.obj", color = {2, 1.95, 1.9} },
  boxes,
}
local solid = shade { from = scene, shadow_samples = 4 }
local drawn = splats {
  from = {sparks, scene}, size = (0.4 + particle_random * particle_random) * over_age { {0, 0.008}, {0.6, 0.005}, {1, 0.001} },
  color = glow(heat).rgb, brightness = 30, streak = streak, soften = 0.01,
}

local picture = over { drawn, solid, from = {drawn, scene} }
local halo    = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown   = final { source = picture, bloom = halo, bloom_intensity = 0.3, exposure_ev = 0.6, tonemap = "agx", saturation = 1.25 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
