-- Where the time of each row goes: its passes, end to end.
local data, h, number, plot = require "data", require "html", require "number", require "plot"

local MAX_BARS = 60

-- The dearest passes get a colour each, in the order in which they run; the rest share the last.
local function choose_passes(sweep)
  local sums, passes = {}, {}
  for _, name in ipairs(data.names(sweep, "gpu")) do
    if name ~= "all" then
      sums[name] = 0
      for _, row in ipairs(sweep.rows) do
        local all, found = row.gpu.all, row.gpu[name]
        if found and all and all.median > 0 then sums[name] = sums[name] + found.median / all.median end
      end
      passes[#passes + 1] = name
    end
  end
  local dear = {}
  for i, name in ipairs(passes) do dear[i] = name end
  table.sort(dear, function(a, b) return sums[a] > sums[b] end)
  local series, shown = {}, 0
  local room = #dear <= plot.SERIES and plot.SERIES or plot.SERIES - 1
  for i, name in ipairs(dear) do
    if i > room then series[name] = plot.SERIES end
  end
  for _, name in ipairs(passes) do
    if not series[name] then
      shown = shown + 1
      series[name] = shown
    end
  end
  return passes, series, #dear > room
end

local function key(passes, series, has_rest)
  local entries = {}
  for _, name in ipairs(passes) do
    if not has_rest or series[name] < plot.SERIES then entries[#entries + 1] = { series = series[name], label = name } end
  end
  if has_rest then entries[#entries + 1] = { series = plot.SERIES, label = "all others" } end
  local out = { class = "key" }
  for _, e in ipairs(entries) do out[#out + 1] = h.li { h.span { class = "swatch b" .. e.series }, e.label } end
  return h.ul(out)
end

-- A part each for passes of one colour, in order; the rest at the end.
local function parts_of(row, passes, series)
  local sums, order = {}, {}
  for _, name in ipairs(passes) do
    local found, s = row.gpu[name], series[name]
    if found then
      if not sums[s] then
        sums[s] = { series = s, ms = 0, names = {} }
        order[#order + 1] = sums[s]
      end
      sums[s].ms = sums[s].ms + found.median
      sums[s].names[#sums[s].names + 1] = name .. " " .. number.short(found.median)
    end
  end
  table.sort(order, function(a, b) return a.series < b.series end)
  return order
end

local function bar(sweep, row, parts, longest, total)
  local svg, at = { class = "stack", ["aria-hidden"] = "true" }, 0
  for _, part in ipairs(parts) do
    local width = part.ms / longest * 100
    svg[#svg + 1] = h.rect { class = "f" .. part.series, x = string.format("%.3f%%", at), y = 0, height = "100%",
      width = string.format("%.3f%%", width), h.title(table.concat(part.names, ", ") .. " ms") }
    at = at + width
  end
  return h.li { h.span { class = "what", data.short_label(sweep, row) }, h.svg(svg),
                h.span { class = "n", number.short(total) } }
end

-- Rows that `get` gives a time for, and the longest of these.
local function timed(sweep, get)
  local rows, longest = {}, 0
  for _, row in ipairs(sweep.rows) do
    local spread = get(row)
    if spread then
      rows[#rows + 1] = row
      longest = math.max(longest, spread.median)
    end
  end
  return rows, longest
end

-- One bar each, where there are no passes to tell apart.
local function plain(sweep)
  local metric = data.metrics(sweep)[1]
  local rows, longest = {}, 0
  if metric then rows, longest = timed(sweep, metric.get) end
  if #rows < 2 or longest <= 0 then return nil end
  local out = { class = "bars" }
  for i = 1, math.min(#rows, MAX_BARS) do
    local ms = metric.get(rows[i]).median
    out[i] = bar(sweep, rows[i], { { series = 1, ms = ms, names = { metric.label .. " " .. number.short(ms) } } }, longest, ms)
  end
  return h.section { id = "passes", h.h2("Time of " .. metric.name),
    h.p { class = "lead", "Milliseconds, medians; rows by ", data.label_head(sweep), "." }, h.ol(out) }
end

return function(sweep)
  local passes, series, has_rest = choose_passes(sweep)
  local rows, longest = timed(sweep, function(row) return row.gpu.all end)
  if #passes < 2 or longest <= 0 then return plain(sweep) end
  local out = { class = "bars" }
  for i = 1, math.min(#rows, MAX_BARS) do
    out[i] = bar(sweep, rows[i], parts_of(rows[i], passes, series), longest, rows[i].gpu.all.median)
  end
  return h.section { id = "passes",
    h.h2 "Where the time goes",
    h.p { class = "lead", "Milliseconds on the device by pass, medians; rows by ", data.label_head(sweep),
          #rows > MAX_BARS and string.format("; the first %d rows", MAX_BARS), "." },
    key(passes, series, has_rest), h.ol(out) }
end
