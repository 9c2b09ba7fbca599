-- Instances of a mesh of 504 triangles: by rays and drawn, in full and simplified.
--
--   roil bench scripts/bench/instances.lua -o out/instances
--   roil bench scripts/bench/instances.lua -o out/instances --size 480x270 --frames 4 --only count=1000
--
-- `geometry` is what finds or draws them. What a pass costs that reads where they are is not in it.

return sweep {
  name = "instances", title = "Instances",
  effect = "effects/wood.lua", size = {1920, 1080}, frames = "10-29", warmup = 4, limit = 120,
  axes = {
    axis { "count", 10, 100, 1000, 10000, 100000 },
    axis { "way",
      { name = "rays in full", mode = "rays", lod = 0 },
      { name = "rays, 1 px", mode = "rays", lod = 1 },
      { name = "rays, 4 px", mode = "rays", lod = 4 },
      { name = "drawn in full", mode = "raster", lod = 0 },
      { name = "drawn, 1 px", mode = "raster", lod = 1 },
      { name = "drawn, 4 px", mode = "raster", lod = 4 },
    },
  },
}
