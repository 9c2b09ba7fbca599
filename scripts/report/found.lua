-- What a search changed: its axes, time and error, before and after.
local data, h, number = require "data", require "html", require "number"

local function find(sweep, index)
  for _, row in ipairs(sweep.rows) do
    if row.index == index then return row end
  end
end

local function line(name, before, after, class)
  return h.tr { class = class, h.th { scope = "row", name }, h.td { class = "n", before or "–" },
                h.td { class = "n", after or "–" } }
end

return function(sweep)
  local before, after = find(sweep, sweep.before), find(sweep, sweep.chosen)
  if not before or not after then return nil end
  local lines = {}
  for _, axis in ipairs(sweep.axes) do
    local a, b = before.axes[axis.name], after.axes[axis.name]
    lines[#lines + 1] = line(axis.label, a, b, a ~= b and "chosen")
  end
  for _, metric in ipairs(data.metrics(sweep)) do
    local a, b = metric.get(before), metric.get(after)
    if a and b then lines[#lines + 1] = line(metric.label .. ", ms", number.short(a.median), number.short(b.median)) end
  end
  for _, kind in ipairs { { "flip", "FLIP" }, { "psnr", "PSNR, dB" }, { "ssim", "SSIM" } } do
    local a, b = before.error[kind[1]], after.error[kind[1]]
    if a and b then lines[#lines + 1] = line(kind[2], number.short(a), number.short(b)) end
  end
  return h.section { id = "found",
    h.h2 "What was found",
    h.div { class = "scroll narrow", tabindex = "0", role = "region", ["aria-label"] = "Before and after", h.table {
      h.thead(h.tr { h.th "", h.th { class = "n", "before" }, h.th { class = "n", "tuned" } }), h.tbody(lines) } } }
end
