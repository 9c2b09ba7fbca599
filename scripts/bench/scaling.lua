-- How time grows with what there is to do: each axis by itself, all others as they are in the middle.
-- Each should be at most linear (an exponent of 1; of `size` that of its pixels, of `voxels`, which are
-- those along a side, that of their number).
--
--   roil bench scripts/bench/scaling.lua -o out/scaling
--   roil bench scripts/bench/scaling.lua -o out/scaling --size 480x270 --frames 30

local middle = { steps = 128, resolution = 1, voxels = 128, lights = 1, size = "1920x1080" }

return sweep {
  name = "scaling", title = "Time against steps, pixels, voxels, lights and output size",
  notes = { "One axis is varied at a time, the others stay at 128 steps, full resolution, 128 voxels, 1 light and 1920x1080.",
            "At most linear is wanted." },
  effect = "effects/puff.lua", frames = "20-31", warmup = 4, limit = 60,
  set = { noise = "worley", octaves = 2, lit = true },
  axes = {
    axis { "steps", 32, 64, 128, 256, 512 },
    axis { "march.resolution", 0.25, 0.5, 1, label = "resolution" },
    axis { "voxels", 32, 64, 128, 256 },
    axis { "lights", 1, 2, 4, 8 },
    axis { "size", {480, 270}, {960, 540}, {1920, 1080}, {3840, 2160} },
  },
  skip = function(row)
    local moved = 0
    for name, value in pairs(middle) do if row[name] ~= value then moved = moved + 1 end end
    return moved > 1
  end,
}
