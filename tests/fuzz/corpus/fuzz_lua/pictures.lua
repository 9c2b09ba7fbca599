-- The whole chain from a field to a picture.
-- expect passes: 10
local fx = effect { name = "pictures", fps = 30, frames = 10 }
fx.camera = orbit { target = { 0, 0, 1 }, distance = 8, yaw = curve { { 0, 0 }, { 4, 360 } }, pitch = 10 }
fx.sun = sun { azimuth = 120, elevation = 40, color = "#fff0e0", strength = 2 }
fx.sky = sky { zenith = { 0.1, 0.2, 0.4 }, horizon = { 0.5, 0.5, 0.6 } }

local ground = geometry {}
local solid = shade { from = ground, haze = 0.01 }
local baked = bake(sphere { radius = 1, falloff = 1 } * perlin {}, { size = { 32, 32, 16 } })
local flow = bake(curl {}, { size = 16, box = { min = { -1, -1, -1 }, max = { 1, 1, 1 } } })
local volume = march {
  name = "fireball",
  density = baked:warp(flow) * sphere {} * 4,
  depth = ground.depth,
  mode = "physical",
  steps = 32,
  resolution = 1 / 2,
}
local both = over(volume, solid)
local again = over { volume = volume.color, source = solid, edge = volume.edge, depth = ground.depth }
local glow = bloom { bright { both, threshold = 2 }, radius = 0.5 }
local shown = final { both, bloom = glow, tonemap = "aces", exposure_ev = 1 }
fx.output = shown.color
fx.linear = shown.linear
fx.depth = ground.depth
assert(again.color)
