-- A small picture of each row that has one.
local data, h, number = require "data", require "html", require "number"

return function(sweep)
  local out = { class = "pictures" }
  local metrics = data.metrics(sweep)
  local metric = metrics[#metrics]
  for _, row in ipairs(sweep.rows) do
    if row.picture then
      local cost, label = metric and metric.get(row), data.short_label(sweep, row)
      out[#out + 1] = h.figure { h.img { src = row.picture, alt = "Picture of row " .. row.index .. ": " .. row.label },
        h.figcaption { label, cost and h.span { class = "n quiet", number.short(cost.median) .. " ms" } } }
    end
  end
  return #out > 0 and h.section { id = "pictures", h.h2 "Pictures", h.div(out) }
end
