-- A step of burning gas by size, cells of its velocity, advection, density, precision, confinement, and what
-- else it carries or is pushed by.
--
--   roil bench scripts/bench/pyro.lua -o out/pyro
--   roil bench scripts/bench/pyro.lua -o out/pyro --size 96x54 --frames 8 --only cells=64
--
-- Times of `pyro.step` are of one step, with its source and what is kept for drawing; the bare solver:
-- tests/bench/pyro.c.

return sweep {
  name = "pyro", title = "Gas that burns",
  notes = { "One step a frame in a box over ground; the picture is small, so that the step is what is measured." },
  effect = "effects/pyro.lua", size = {320, 180}, frames = "40-59", warmup = 4, limit = 60,
  axes = {
    axis { "cells", 32, 64, 96, 128, 192, 256 },
    axis { "velocity",
      { name = "full", ["pyro.velocity_cells"] = "full" },
      { name = "half", ["pyro.velocity_cells"] = "half" },
    },
    axis { "advection",
      { name = "parabolic", ["pyro.advection"] = "parabolic" },
      { name = "upwind", ["pyro.advection"] = "upwind" },
      { name = "reflection", ["pyro.advection"] = "reflection" },
    },
    axis { "precision",
      { name = "f16", ["pyro.precision"] = "f16" },
      { name = "f32", ["pyro.precision"] = "f32" },
    },
    axis { "density",
      { name = "constant", ["pyro.density"] = "constant" },
      { name = "variable", ["pyro.density"] = "variable" },
    },
    axis { "vorticity",
      { name = "none" },
      { name = "confined", ["pyro.vorticity"] = 4 },
    },
    axis { "more",
      { name = "nothing" },
      { name = "smoke", ["pyro.smoke_yield"] = 0.1 },
      { name = "turbulence", ["pyro.turbulence"] = 0.3 },
    },
  },
  -- Sizes are measured for what most effects have; each other thing alone at one size.
  skip = function(row)
    local others = 0
    for name, most in pairs { advection = "parabolic", density = "constant", vorticity = "none", more = "nothing" } do
      if row[name] ~= most then others = others + 1 end
    end
    return others > 1 or (others == 1 and row.cells ~= 128)
  end,
}
