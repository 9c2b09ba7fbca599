-- Time and memory of a volume by its size: a grid that is computed each frame, and one that is played.
--
--   roil bench scripts/bench/volume.lua -o out/volume
--   roil bench scripts/bench/volume.lua -o out/volume --size 480x270 --frames 30 --only voxels=64

return sweep {
  name = "volume", title = "Size of the volume",
  notes = { "Error is against the same noise without a grid." },
  effect = "effects/puff.lua", size = {1920, 1080}, frames = "20-31", warmup = 4, limit = 60,
  set = { noise = "worley", octaves = 2 },
  axes = { axis { "voxels", 32, 64, 128, 256 }, axis { "steps", 64, 128 } },
  reference = { voxels = 0 },
}
