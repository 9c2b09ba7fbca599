-- Time against each axis of numbers: a line for each value of another axis, a panel for each
-- combination of the rest, and how time grows.
local data, h, number, plot, scale = require "data", require "html", require "number", require "plot", require "scale"
local px = plot.px

local MAX_PANELS = 12

-- ---- what goes where ----------------------------------------------------------------------------

-- The axis whose values are the lines: rather words than numbers, rather few than many.
local function choose_lines(axes)
  local best
  for _, axis in ipairs(axes) do
    local fits = #axis.values <= plot.SERIES
    local better = not best or fits and (#best.values > plot.SERIES or best.numeric and not axis.numeric)
    if better then best = axis end
  end
  return best
end

-- The other axes that vary where this one does: not those that it decides.
local function other_axes(sweep, x)
  local out = {}
  for _, axis in ipairs(sweep.axes) do
    local decided, known = true, {}
    for _, row in ipairs(sweep.rows) do
      local at, value = row.axes[x.name], row.axes[axis.name]
      if at and value then
        known[at] = known[at] or value
        decided = decided and known[at] == value
      end
    end
    if axis ~= x and not axis.zipped and #axis.values > 1 and not decided then out[#out + 1] = axis end
  end
  return out
end

local function add_point(panels, row, x, series_axis, facets, metric)
  local spread, at = metric.get(row), row.axes[x.name]
  if not row.done or not spread or not at then return end
  local parts = {}
  for _, axis in ipairs(facets) do
    parts[#parts + 1] = axis.label .. " " .. (row.axes[axis.name] or "-")
  end
  local title = table.concat(parts, ", ")
  local panel = panels[title]
  if not panel then
    panel = { title = title, lines = {} }
    panels[title], panels[#panels + 1] = panel, panel
  end
  local name = series_axis and (row.axes[series_axis.name] or "-") or ""
  local line = panel.lines[name] or { name = name }
  panel.lines[name] = line
  line[#line + 1] = { x = x.number[at], y = spread.median, low = spread.p5, high = spread.p95, row = row, at = at, spread = spread }
end

local function has_line(panel)
  for _, line in ipairs(panel.lines) do
    if #line > 1 then return true end
  end
  return false
end

-- Panels with their lines, { x, y, low, high } each, in the order of the axis that they stand for.
-- Those without any line of two points show nothing of the axis.
local function arrange(sweep, x, metric)
  local others = other_axes(sweep, x)
  local series_axis = choose_lines(others)
  local facets, panels = {}, {}
  for _, axis in ipairs(others) do
    if axis ~= series_axis then facets[#facets + 1] = axis end
  end
  for _, row in ipairs(sweep.rows) do add_point(panels, row, x, series_axis, facets, metric) end
  for _, panel in ipairs(panels) do
    for i, name in ipairs(series_axis and series_axis.values or { "" }) do
      local line = i <= plot.SERIES and panel.lines[name]
      if line then
        line.series = i
        table.sort(line, function(a, b) return a.x < b.x end)
        panel.lines[#panel.lines + 1] = line
      end
    end
  end
  local shown = {}
  for _, panel in ipairs(panels) do
    if has_line(panel) then shown[#shown + 1] = panel end
  end
  return shown, series_axis
end

-- ---- drawing ------------------------------------------------------------------------------------

local function bounds(panels)
  local b = { x_low = math.huge, x_high = -math.huge, y_low = math.huge, y_high = -math.huge, label = 0 }
  for _, panel in ipairs(panels) do
    for _, line in ipairs(panel.lines) do
      b.label = math.max(b.label, plot.text_width(plot.shorten(line.name, 16)))
      for _, p in ipairs(line) do
        b.x_low, b.x_high = math.min(b.x_low, p.x), math.max(b.x_high, p.x)
        b.y_low, b.y_high = math.min(b.y_low, p.low), math.max(b.y_high, p.high)
      end
    end
  end
  return b
end

local function draw_line(line, x, y, metric)
  local path, marks = {}, {}
  for i, p in ipairs(line) do
    local at, up = x.place(p.x), y.place(p.y)
    path[i] = string.format("%s%.1f %.1f", i == 1 and "M" or "L", at, up)
    local low, high = y.place(p.low), y.place(p.high)
    if low - high > 5 then
      marks[#marks + 1] = h.line { class = "whisker s" .. line.series, x1 = px(at), x2 = px(at), y1 = px(low), y2 = px(high) }
    end
    marks[#marks + 1] = plot.marker(line.series, at, up, 3.2, string.format("%s: %s %s ms (%s to %s)", p.row.label,
      metric.label, number.short(p.y), number.short(p.low), number.short(p.high)))
  end
  return { h.path { class = "line s" .. line.series, d = table.concat(path) }, marks }
end

-- Names stand behind the last point of their line, those of lines that end together apart.
local function draw_labels(panel, x, y, box)
  local columns, out = {}, {}
  for _, line in ipairs(panel.lines) do
    local last = line[#line]
    if line.name ~= "" then
      local labels = columns[last.x] or {}
      columns[last.x] = labels
      labels[#labels + 1] = { y = y.place(last.y), name = line.name, series = line.series }
    end
  end
  for at, labels in pairs(columns) do
    local from = x.place(at) + 18
    plot.spread(labels, box.top, box.bottom)
    for _, label in ipairs(labels) do
      out[#out + 1] = math.abs(label.place - label.y) > 4 and h.line { class = "leader s" .. label.series,
        x1 = px(from - 14), y1 = px(label.y), x2 = px(from - 2), y2 = px(label.place) }
      out[#out + 1] = h.text { class = "label f" .. label.series, x = px(from), y = px(label.place + 4),
                               plot.shorten(label.name, 16), h.title(label.name) }
    end
  end
  return out
end

-- Ticks at the values that were measured, as they were written, where these are few.
local function measured_ticks(axis, x, b)
  if #axis.values > 8 then return end
  local texts = {}
  x.ticks = {}
  for _, value in ipairs(axis.values) do
    local at = axis.number[value]
    if at >= b.x_low and at <= b.x_high then
      x.ticks[#x.ticks + 1] = at
      texts[at] = axis.size and value:gsub("%s*[x,]%s*", "×") or value
    end
  end
  x.text = function(tick) return texts[tick] end
end

local function draw_panel(panel, axis, b, metric)
  local right = plot.WIDTH - math.max(b.label + 16, 22)
  local box = { left = plot.LEFT, right = right, top = plot.TOP + 12, bottom = plot.HEIGHT - plot.BOTTOM }
  local x = scale.new { low = b.x_low, high = b.x_high, from = box.left, to = box.right,
                        log = scale.wants_log(b.x_low, b.x_high, 4), ticks = 6 }
  local y = scale.new { low = b.y_low, high = b.y_high, from = box.bottom, to = box.top, zero = true,
                        log = scale.wants_log(b.y_low, b.y_high, 8) and x.log, ticks = 6 }
  measured_ticks(axis, x, b)
  local svg = { class = "plot", viewBox = string.format("0 0 %d %d", plot.WIDTH, plot.HEIGHT), role = "img",
                ["aria-label"] = string.format("%s, milliseconds against %s. %s", metric.label, axis.label, panel.title),
                plot.frame(box, x, y, axis.size and axis.label .. ", by pixels" or axis.label, "ms") }
  for _, line in ipairs(panel.lines) do svg[#svg + 1] = draw_line(line, x, y, metric) end
  svg[#svg + 1] = draw_labels(panel, x, y, box)
  return h.svg(svg)
end

-- ---- growth -------------------------------------------------------------------------------------

-- What there is more of as the axis goes up: time is held against that.
local function work_of(axis)
  return axis.size and "pixels" or axis.unit and axis.unit .. "s" or axis.label
end

-- Whether times differ by more than they spread: else an exponent would be one of noise.
local function moves(line)
  local least, greatest = math.huge, -math.huge
  for _, p in ipairs(line) do
    local low, high = data.bounds(p.spread)
    least, greatest = math.min(least, high), math.max(greatest, low)
  end
  return greatest > least
end

local function exponents(panels, axis)
  local all, moved = {}, false
  for _, panel in ipairs(panels) do
    for _, line in ipairs(panel.lines) do
      local sure = moves(line)
      local exponent = sure and scale.exponent(line) or nil
      moved = moved or sure
      line.exponent = exponent and exponent / axis.dimension
      all[#all + 1] = line.exponent
    end
  end
  return all, moved
end

local function power(value)
  return string.format("%.2f", value)
end

-- Whether time grows faster than the work does; 0.05 is within what a fit of noisy times may miss.
local function growth(metric, axis, panels)
  local all, moved = exponents(panels, axis)
  if not moved then
    return string.format("Time of %s does not change with %s by more than it spreads.", metric.name, work_of(axis))
  end
  if #all == 0 then return nil end
  local least, greatest = math.min(table.unpack(all)), math.max(table.unpack(all))
  local range = power(least) == power(greatest) and power(least) or power(least) .. " to " .. power(greatest)
  local verdict = greatest <= 1.05 and "at most linearly" or least > 1.05 and "faster than linearly" or "in places faster than linearly"
  return string.format("Time of %s grows with %s to the power of %s, %s.", metric.name, work_of(axis), range, verdict)
end

local function caption(panel, axis)
  local parts = {}
  for _, line in ipairs(panel.lines) do
    if line.exponent then
      parts[#parts + 1] = (line.name ~= "" and plot.shorten(line.name, 24) .. " " or "") .. power(line.exponent)
    end
  end
  return #parts > 0 and h.figcaption { "power of ", work_of(axis), ": ", table.concat(parts, ", ") }
end

-- ---- the section --------------------------------------------------------------------------------

local function not_drawn(panels, series_axis)
  local parts = {}
  if #panels > MAX_PANELS then parts[1] = number.of(#panels - MAX_PANELS, "combination") end
  if series_axis and #series_axis.values > plot.SERIES then
    parts[#parts + 1] = number.of(#series_axis.values - plot.SERIES, "value") .. " of " .. series_axis.label
  end
  return #parts > 0 and " Not drawn: " .. table.concat(parts, ", ") .. "."
end

-- An element and a sentence. The first metric stands open, others can be opened.
local function group(sweep, axis, metric, first)
  local panels, series_axis = arrange(sweep, axis, metric)
  local b = bounds(panels)
  if #panels == 0 or b.x_high <= b.x_low then return nil end
  local sentence = growth(metric, axis, panels)
  local shown = { class = "panels" }
  for i, panel in ipairs(panels) do
    if i <= MAX_PANELS then
      shown[i] = h.figure { panel.title ~= "" and h.h4(panel.title), draw_panel(panel, axis, b, metric), caption(panel, axis) }
    end
  end
  local title = metric.label .. " by " .. axis.label
  local lead = h.p { class = "lead", sentence, series_axis and " A line for each " .. series_axis.label .. ".", not_drawn(panels, series_axis) }
  if first then return h.section { h.h3(title), lead, h.div(shown) }, sentence end
  return h.details { h.summary(title), lead, h.div(shown) }, sentence
end

-- The section, and sentences for the summary; nil when no axis has numbers.
return function(sweep)
  local out, said = {}, {}
  for _, axis in ipairs(sweep.axes) do
    for i, metric in ipairs(axis.numeric and not axis.zipped and data.metrics(sweep, axis) or {}) do
      local element, sentence = group(sweep, axis, metric, i == 1)
      out[#out + 1] = element
      if element and i == 1 then said[#said + 1] = sentence end
    end
  end
  return #out > 0 and h.section { id = "plots", h.h2 "How time grows", out }, said
end
