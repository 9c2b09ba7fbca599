-- How soon an edit of an effect is seen in a running `roil live`: from the close of the file to the
-- submission of the first frame that shows it. A copy of the effect is edited, with a cache of its own.
--
--   roil bench scripts/bench/reload.lua -o out/reload
--   roil bench scripts/bench/reload.lua -o out/reload --repeats 5

local numbers = { "1400" }
for i = 1, 50 do numbers[i + 1] = tostring(1000 + i) end

-- A product with factors in an order that never was: numbers are uniforms, only another tree is another code.
local trees = { "cover * crust" }
for i = 1, 63 do
  local factors = {}
  for bit = 0, 5 do factors[bit + 1] = i & (1 << bit) ~= 0 and "clamp(1 * smoke, 1, 1) * " or "min(smoke, 0) * 0 + " end
  trees[i + 1] = table.concat(factors) .. "cover * crust"
end

return sweep {
  name = "reload", title = "From an edit to its first frame", measure = "reload",
  notes = { "Drawing is left out: the device is idle when the file is written, and nothing waits for it after." },
  effect = "../../effects/explosion.lua", size = {96, 54}, frames = 20, warmup = 2, repeats = 50,
  axes = {
    axis { "edit",
      { name = "number", edit = numbers },
      { name = "structure, compiled before", edit = { 'worley_curl", words', 'perlin", words', 'worley_curl", words' } },
      { name = "structure, new", edit = trees },
    },
  },
}
