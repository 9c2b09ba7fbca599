-- Particles: how many, how large, and how they are laid over each other.
--
--   roil bench scripts/bench/particles.lua -o out/particles
--   roil bench scripts/bench/particles.lua -o out/particles --size 480x270 --frames 8 --only count=65536
--
-- `particles.step` is their motion, `splats` their drawing. The published ones (Krueger and Westermann
-- 2005, table 4: 16384 to 1048576) are a pixel wide at last.

return sweep {
  name = "particles", title = "Particles",
  effect = "effects/swarm.lua", size = {1920, 1080}, frames = "10-29", warmup = 4, limit = 120,
  axes = {
    axis { "count", 16384, 65536, 262144, 1048576, 4194304, 16777216 },
    axis { "look",
      { name = "1 px", pixels = 1 },
      { name = "1 px, streaks", pixels = 1, streak = 0.02 },
      { name = "8 px", pixels = 8 },
      { name = "32 px", pixels = 32 },
    },
    axis { "blend", "additive", "weighted", "sorted" },
  },
  -- More than a million are points that are not sorted; more than 65536 are no large ones.
  skip = function(row)
    if row.count > 1048576 then return row.blend ~= "additive" or row.look ~= "1 px" end
    return row.look == "32 px" and row.count > 65536
  end,
}
