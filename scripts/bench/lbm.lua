-- A step of simulated air by size, velocity set, precision, collision and what the air carries.
--
--   roil bench scripts/bench/lbm.lua -o out/lbm
--   roil bench scripts/bench/lbm.lua -o out/lbm --size 96x54 --frames 8 --only cells=64
--
-- Times of `lbm.step` are of one step, with sources and what is kept for drawing; the bare solver:
-- tests/bench/lattice.c.

return sweep {
  name = "lbm", title = "Simulated air",
  notes = { "One step a frame in a periodic box; the picture is small, so that the step is what is measured." },
  effect = "effects/air.lua", size = {320, 180}, frames = "40-59", warmup = 4, limit = 60,
  axes = {
    axis { "cells", 32, 64, 96, 128, 192, 256 },
    axis { "set",
      { name = "d3q19", ["lbm.velocity_set"] = "d3q19" },
      { name = "d3q27", ["lbm.velocity_set"] = "d3q27" },
      { name = "d3q27, as published", ["lbm.velocity_set"] = "d3q27", ["lbm.scalar_set"] = "d3q27", ["lbm.collision"] = "bgk" },
      { name = "d3q19, bgk", ["lbm.collision"] = "bgk" },
      { name = "d3q19, trt", ["lbm.collision"] = "trt" },
    },
    axis { "precision",
      { name = "f16", ["lbm.precision"] = "f16" },
      { name = "f32", ["lbm.precision"] = "f32" },
    },
    axis { "carried", 1, 2, 3 },
  },
  -- Sizes are measured for the two sets and what most effects carry, all else at one size.
  skip = function(row)
    local plain = row.set == "d3q19" or row.set == "d3q27"
    return row.cells ~= 128 and not (plain and row.carried == 2) or not plain and row.carried ~= 2
  end,
}
