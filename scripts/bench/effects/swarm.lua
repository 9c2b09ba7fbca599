-- A ball of particles that turns, for scripts/bench/particles.lua: all there from the first frame on.
local fx = effect { name = "swarm", fps = 60, frames = 600 }

local count   = param { "count", 65536, min = 1, max = 16777216, integer = true }
local pixels  = param { "pixels", 1, min = 0.1, max = 200, help = "diameter of a splat in a picture of 1080 rows" }
local streak  = param { "streak", 0, min = 0, max = 1 }
local blend   = param { "blend", "additive", words = {"additive", "weighted", "sorted"} }
local n       = count:get()

fx.camera = camera { eye = {0, -5, 0}, target = {0, 0, 0}, fov = 36 }

local swarm = particles {
  count = n, burst = n, lifetime = 1e6, radius = 1.4, seed = 2, time_step = 1 / 60,
  velocity = vec(-position.y, position.x, 0.3 * sin(3 * position.x)),
}
local colors = palette { {0, "#ff5020"}, {0.5, "#ffd060"}, {1, "#4080ff"} }
local metres = 2 * 5 * math.tan(math.rad(18)) / 1080 -- of a pixel, in the middle
local drawn  = splats {
  from = swarm, size = pixels * metres, color = colors(particle_random).rgb, streak = streak,
  opacity = 0.5, brightness = 0.5, blend = blend, entries = 16,
}
fx.output = final { drawn }
return fx
