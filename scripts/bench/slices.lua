-- The four tables of Krueger and Westermann, "GPU simulation and rendering of volumetric effects for
-- computer games and virtual environments" (2005), section 6: grids, templates, the volume, particles.
--
--   roil bench scripts/bench/slices.lua -o out/slices
--   roil bench scripts/bench/slices.lua -o out/slices --size 480x270 --frames 40-47 --rows 'templates 128*'
--
-- Times of the first two tables are those of `slices.step`, `slices.sources` and `slices.templates`; of
-- the others whole frames. Published are frames a second, here as milliseconds of a frame.

-- Tables 1 to 4.
local frames_a_second = {
  grid      = { ["128x128"] = 443, ["256x64"] = 443, ["256x256"] = 221, ["512x512"] = 54 },
  ["templates 128"] = { [0] = 443, [5] = 411, [10] = 391, [20] = 369, [40] = 326, [80] = 256, [200] = 166 },
  ["templates 256"] = { [0] = 211, [5] = 209, [10] = 208, [20] = 206, [40] = 204, [80] = 202, [200] = 153 },
  volume    = { [64] = 190, [128] = 152, [256] = 62 },
  particles = { [16384] = 190, [65536] = 128, [262144] = 60, [1048576] = 21 },
}

local rows, places = {}, {}
local function row(name, group, key, values)
  places[name] = { group, key }
  values.name = name
  rows[#rows + 1] = values
end

local small = {64, 64} -- of the picture, where it is not what is measured
for _, cells in ipairs { {128, 128}, {256, 64}, {256, 256}, {512, 512}, {1024, 1024} } do
  local name = cells[1] .. "x" .. cells[2]
  row("grid " .. name, "grid", name, { width = cells[1], height = cells[2], size = small })
  for _, solver in ipairs { "multigrid", "cg" } do
    row("grid " .. name .. " " .. solver, "grid", name, { width = cells[1], height = cells[2], size = small, ["slices.solver"] = solver })
  end
end
for _, cells in ipairs { 128, 256 } do
  for _, n in ipairs { 0, 5, 10, 20, 40, 80, 200 } do
    local values = { width = cells, height = cells, templates = n, size = small, ["slices.solver"] = "multigrid" } -- with none, too
    row("templates " .. cells .. ": " .. n, "templates " .. cells, n, values)
  end
end
for _, n in ipairs { 64, 128, 256 } do
  for _, how in ipairs { "stack", "march", "baked" } do
    row("volume " .. n .. " " .. how, "volume", n, { count = 2, templates = 40, shown = how, planes = n })
  end
end
for _, n in ipairs { 16384, 65536, 262144, 1048576 } do
  row("particles " .. n, "particles", n, { count = 2, templates = 50, shown = "particles", points = n })
end

return sweep {
  name = "slices", title = "The published tables: grids, templates, volume, particles",
  notes = {
    "Published: ATI X800 XT (grids, templates, volume) and NVIDIA 6800 GT (particles) of 2004, in frames a second, here as milliseconds.",
    "Grids: by the solver that the flow takes by itself, a transform, where there is nothing in its way; by multigrid, which templates need; and by conjugate gradients, as published.",
    "Volume: two slices and 40 templates; stack is the published rendering, into 256 x 256; march and baked are ours.",
    "Particles: two slices of 128 x 128 and 50 templates.",
  },
  effect = "effects/slices.lua", size = {1920, 1080}, frames = "60-79", warmup = 8, limit = 60,
  axes = { axis { "table", table.unpack(rows) } },
  published = function(one)
    local group, key = table.unpack(places[one.table])
    local speed = frames_a_second[group][key]
    return { ["2005"] = speed and 1000 / speed }
  end,
}
