-- What makes a picture look drawn, and each bloom, beside the same picture without: lines along edges,
-- bands, models of light, the bloom by levels and by the published blur.
--
--   roil bench scripts/bench/toon.lua -o out/toon
--   roil bench scripts/bench/toon.lua -o out/toon --size 480x270 --frames 4
--
-- A row's passes say what it costs: `outline`, `bands`, `bloom`, `shade`.

local rows = {}
local function row(name, values)
  values.name = name
  rows[#rows + 1] = values
end

for _, model in ipairs { "physical", "lambert", "blinn_phong", "toon" } do row("shade " .. model, { model = model }) end
for _, pixels in ipairs { 1, 2.5, 5, 10 } do row("outline " .. pixels .. " px", { add = "outline", thickness = pixels }) end
row("outline by depth alone", { add = "outline depth" })
row("outline as published", { add = "outline published" })
row("bands", { add = "bands" })
for _, part in ipairs { 1, 0.5, 0.25 } do
  row("bloom by levels, of " .. part, { add = "bloom mips", part = part })
  for _, passes in ipairs { 1, 5, 10 } do
    row("bloom of " .. passes .. " passes, of " .. part, { add = "bloom gaussian", passes = passes, part = part })
  end
end

return sweep {
  name = "toon", title = "Drawn pictures and bloom",
  effect = "effects/drawn.lua", size = {1920, 1080}, frames = "10-29", warmup = 4, limit = 60,
  axes = { axis { "what", table.unpack(rows) } },
}
