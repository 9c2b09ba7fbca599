-- A burning puff: seen at rest, by a moving camera, and moving itself. Measured by bench_flicker.
local fx = effect { name = "flicker", fps = 24, frames = 60, first = 1 }
local motion   = param { "motion", "none", words = {"none", "camera", "wind", "fire"}, help = "what moves" }
local steps    = param { "steps", 16, min = 1, max = 1024, integer = true, help = "along each ray" }
local jitter   = param { "jitter", 1, min = 0, max = 1, help = "random part of a step" }
local random   = param { "random", "blue", words = {"blue", "white"}, help = "what jitters the samples" }
local gathered = param { "gathered", 8, min = 0, max = 64, help = "frames that are averaged; 0: no pass for it" }
local response = param { "response", 1, min = 0, max = 1, help = "of the blurred picture" }
local known    = param { "known", 0, min = 0, max = 1, help = "1: accumulate knows the wind" }
local spread   = param { "spread", 1, min = 0, max = 10, help = "how far the history may differ" }

local camera_moves, fire_moves = motion:get() == "camera", motion:get() == "fire"
local wind = motion:get() == "wind" and 0.4 or 0 -- m/s: carries everything
fx.camera = orbit { target = {0, 0, 1.4}, distance = 4.5, pitch = 8, fov = 35,
                    yaw = camera_moves and function(t) return 20 * t end or 0 }
fx.sun = sun { azimuth = 210, elevation = 40, strength = 3 }

local lumps = perlin { frequency = 2.2, octaves = 3, seed = 4,
                       drift = fire_moves and {0, 0, -1} or {-wind, 0, 0}, speed = fire_moves and 1 or 0 }
local puff  = sphere { position = function(t) return {wind * (t - 1.25), 0, 1.4} end, radius = 1.2, falloff = 0.8 }
local body  = smoothstep(0.15, 0.75, puff * (0.3 + 1.2 * lumps))
local scene = geometry { mesh { "ground.obj" } }
local solid = shade { from = scene }

local volume = march {
  density  = body * 12,
  emission = body * smoothstep(0.45, 0.7, lumps) * vec(90, 26, 4),
  albedo   = {0.6, 0.58, 0.55},
  steps    = steps,
  jitter   = jitter,
  jitter_noise = random:get(),
  depth    = scene.depth,
}
local layer = volume.color
if gathered:get() > 0 then
  layer = accumulate { from = volume, source = volume.color, depth = scene.depth,
                       frames = gathered, spread = spread, response = response,
                       velocity = vec(wind, 0, 0) * known }.color
end
local picture = over { volume = layer, edge = volume.edge, source = solid, depth = scene.depth }
fx.output = final { picture, tonemap = "reinhard" }.color
return fx
