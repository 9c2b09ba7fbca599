-- What each kind of noise costs in a march: all of them in the same ball of smoke, at one to four octaves.
--
--   roil bench scripts/bench/noise.lua -o out/noise
--   roil bench scripts/bench/noise.lua -o out/noise --size 480x270 --frames 30

return sweep {
  name = "noise", title = "Cost of the kinds of noise",
  notes = { "No noise costs the same at any number of octaves: it is what all others come on top of." },
  effect = "effects/puff.lua", size = {1920, 1080}, frames = "20-31", warmup = 4, limit = 60,
  axes = {
    axis { "noise", "none", "value", "perlin", "perlin_4d", "simplex", "worley", "worley_paper", "worley_f2_f1", "curl", "worley_curl",
           "worley_tiled" },
    axis { "octaves", 1, 2, 4 },
  },
  skip = function(row) return row.noise == "none" and row.octaves > 1 end,
}
