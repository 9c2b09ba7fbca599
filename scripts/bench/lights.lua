-- Point lights: how many, how a pixel finds those that reach it, and which path draws the scene.
--
--   roil bench scripts/bench/lights.lua -o out/lights
--   roil bench scripts/bench/lights.lua -o out/lights --size 480x270 --frames 8 --only lights=200
--
-- `shade` of the deferred path is all of its light, lists and spheres with it; `forward` does the same in
-- the fragments of what it draws.

return sweep {
  name = "lights", title = "Point lights",
  effect = "../../effects/deferred_lights.lua", size = {1920, 1080}, frames = "10-29", warmup = 4, limit = 120,
  axes = {
    axis { "lights", 1, 10, 50, 100, 200, 500, 1000, 4000 },
    axis { "way",
      { name = "deferred, tiles", point_lights_by = "tiles" },
      { name = "deferred, volumes", point_lights_by = "volumes" },
      { name = "deferred, all", point_lights_by = "all" },
      { name = "forward, tiles", path = "forward", point_lights_by = "tiles" },
      { name = "forward, all", path = "forward", point_lights_by = "all" },
    },
  },
  skip = function(row) return row.lights > 1000 and row.way ~= "deferred, tiles" end,
}
