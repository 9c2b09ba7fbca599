-- What more cells and more particles add to the picture, and what they cost: figures 12 and 13 of Krueger
-- and Westermann (2005), and what memory the whole takes.
--
--   roil bench scripts/bench/slices_look.lua -o out/slices_look
--   roil bench scripts/bench/slices_look.lua -o out/slices_look --frames 60 --limit 0     -- without a graphics card
--
-- Cells: each picture is compared with that of 512 x 512 cells, as it is ("all"), and after what is
-- smaller than two cells of 128 x 128 has been blurred away in both ("large"). What is in "all" and not in
-- "large" is small-scale detail. A flow that 40 templates stir has more of it than a calm one. Particles:
-- each is compared with the picture of 4 million particles of one pixel.

local frames_a_second = { [16384] = 190, [65536] = 128, [262144] = 60, [1048576] = 21 } -- of particles: table 4

local rows, published = {}, {}
local function row(name, values)
  published[name] = { ["2005"] = values.points and 1000 / frames_a_second[values.points] }
  values.name = name
  rows[#rows + 1] = values
end

for _, flow in ipairs { "calm", "stirred" } do
  local stirred = flow == "stirred"
  for _, n in ipairs { 32, 64, 128, 256, 512 } do
    for _, seen in ipairs { "all", "large" } do
      row("cells " .. n .. ", " .. flow .. ": " .. seen, {
        width = n, height = n, templates = stirred and 40 or 0, ["slices.vorticity"] = stirred and 6 or 2,
        shown = "march", planes = 256, large = seen == "large",
      })
    end
  end
end
for _, look in ipairs { {16384, 8}, {16384, 1}, {65536, 4}, {65536, 1}, {262144, 2}, {262144, 1}, {1048576, 2}, {1048576, 1} } do
  local n, pixels = table.unpack(look)
  row("particles " .. n .. ": " .. pixels .. " px", { templates = 50, shown = "particles", points = n, pixels = pixels })
end

return sweep {
  name = "slices_look", title = "What more cells and more particles add",
  notes = {
    "Published: frames a second of table 4, here as milliseconds; those of the grids alone are in slices.lua.",
    "Error: against 512 x 512 cells, or 4194304 particles of one pixel. 'large' has lost what is smaller than two cells of 128, in both.",
    "Memory is that of the whole effect, pictures included.",
  },
  effect = "effects/slices.lua", size = {512, 512}, frames = "60-63", warmup = 0, limit = 120,
  set = { count = 2 },
  axes = { axis { "table", table.unpack(rows) } },
  reference = { best = true },
  published = function(one) return published[one.table] end,
}
