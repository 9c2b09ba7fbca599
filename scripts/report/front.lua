-- Cost against error, and the rows that no other beats in both: the Pareto front.
local data, h, number, plot, scale = require "data", require "html", require "number", require "plot", require "scale"
local px = plot.px

local RING = 8 -- radius of the mark around rows of a search

-- What errors a row may have: `up`: more is better.
local ERRORS = { { name = "flip", label = "FLIP" }, { name = "psnr", label = "PSNR, dB", up = true },
                 { name = "ssim", label = "SSIM", up = true } }

local function gather(sweep, kind, metric)
  local points = {}
  for _, row in ipairs(sweep.rows) do
    local cost, err = metric.get(row), row.error[kind.name]
    if row.done and cost and err then points[#points + 1] = { x = cost.median, y = err, row = row } end
  end
  return points
end

-- Sorted by cost, those whose error is below all that are cheaper.
local function find_front(points, kind)
  local sorted, front = {}, {}
  for i, p in ipairs(points) do sorted[i] = p end
  local function worse(p) return kind.up and -p.y or p.y end
  table.sort(sorted, function(a, b) if a.x ~= b.x then return a.x < b.x end return worse(a) < worse(b) end)
  local best
  for _, p in ipairs(sorted) do
    if not best or worse(p) < best then
      best = worse(p)
      front[#front + 1] = p
      p.front = true
    end
  end
  return front
end

-- Colours by the axis that has few enough values, rather words than numbers.
local function color_axis(sweep)
  local best
  for _, axis in ipairs(sweep.axes) do
    if not axis.zipped and #axis.values > 1 and #axis.values <= plot.SERIES and
       (not best or best.numeric and not axis.numeric) then best = axis end
  end
  return best
end

local function series_of(axis, row)
  for i, value in ipairs(axis and axis.values or {}) do
    if row.axes[axis.name] == value then return i end
  end
  return 1
end

local function extent(points, field)
  local low, high = math.huge, -math.huge
  for _, p in ipairs(points) do low, high = math.min(low, p[field]), math.max(high, p[field]) end
  return low, high
end

-- What a row is to the search that these are results of; nil when they are of none.
local function mark_of(sweep, row)
  return row.index == sweep.chosen and "tuned" or row.index == sweep.before and "before" or nil
end

-- Steps, since between two rows nothing was measured.
local function draw_front(front, x, y)
  local path = {}
  for i, p in ipairs(front) do
    path[i] = i == 1 and string.format("M%.1f %.1f", x.place(p.x), y.place(p.y))
      or string.format("H%.1fV%.1f", x.place(p.x), y.place(p.y))
  end
  return h.path { class = "front", d = table.concat(path) }
end

-- What labels must not cover: all marks, and the steps of the front.
local function obstacles(sweep, points, front, x, y)
  local out = {}
  for _, p in ipairs(points) do
    local at, up, r = x.place(p.x), y.place(p.y), mark_of(sweep, p.row) and RING + 1 or 3
    out[#out + 1] = { left = at - r, right = at + r, top = up - r, bottom = up + r }
  end
  for i = 2, #front do
    local x1, y1, x2, y2 = x.place(front[i - 1].x), y.place(front[i - 1].y), x.place(front[i].x), y.place(front[i].y)
    out[#out + 1] = { left = x1, right = x2, top = y1 - 1, bottom = y1 + 1 }
    out[#out + 1] = { left = x2 - 1, right = x2 + 1, top = math.min(y1, y2), bottom = math.max(y1, y2) }
  end
  return out
end

-- Labels of the marked rows, then of the front from its ends inwards, while there is room.
local function draw_labels(sweep, points, front, x, y, box)
  local taken, out, wanted = obstacles(sweep, points, front, x, y), {}, {}
  for _, p in ipairs(points) do
    local mark = mark_of(sweep, p.row)
    if mark then wanted[#wanted + 1] = { p = p, text = mark, class = "label strong" } end
  end
  for i = 1, #front do
    local p = i % 2 == 1 and front[(i + 1) // 2] or front[#front + 1 - i // 2]
    wanted[#wanted + 1] = { p = p, text = plot.shorten(data.short_label(sweep, p.row), 26), class = "label" }
  end
  for _, w in ipairs(wanted) do
    local at, up = plot.fit(w.text, x.place(w.p.x), y.place(w.p.y), box, taken)
    if at then out[#out + 1] = h.text { class = w.class, x = px(at), y = px(up), w.text } end
  end
  return out
end

local function draw(sweep, points, front, kind, metric, axis, width, height, class)
  local box = { left = plot.LEFT, right = width - 12, top = plot.TOP + 12, bottom = height - plot.BOTTOM }
  local x_low, x_high = extent(points, "x")
  local y_low, y_high = extent(points, "y")
  local x = scale.new { low = x_low, high = x_high, from = box.left, to = box.right, zero = true,
                        log = scale.wants_log(x_low, x_high, 3), ticks = 6 }
  local y = scale.new { low = y_low, high = y_high, from = box.bottom, to = box.top, zero = not kind.up,
                        log = not kind.up and scale.wants_log(y_low, y_high, 5), ticks = 6 }
  local svg = { class = "plot " .. class, viewBox = string.format("0 0 %d %d", width, height), role = "img",
                ["aria-label"] = string.format("%s against %s, a mark for each row", kind.label, metric.label),
                plot.frame(box, x, y, metric.label .. ", ms", kind.label), draw_front(front, x, y) }
  for _, p in ipairs(points) do
    local title = string.format("%s: %s ms, %s %s", p.row.label, number.short(p.x), kind.label, number.short(p.y))
    svg[#svg + 1] = plot.marker(series_of(axis, p.row), x.place(p.x), y.place(p.y), p.front and 4 or 2.8, title)
    svg[#svg + 1] = mark_of(sweep, p.row) and h.circle { class = "ring", cx = px(x.place(p.x)), cy = px(y.place(p.y)), r = RING }
  end
  svg[#svg + 1] = draw_labels(sweep, points, front, x, y, box)
  return h.svg(svg)
end

local function list_front(sweep, front, kind, metric)
  local rows = {}
  for i, p in ipairs(front) do
    rows[i] = h.tr { class = p.row.index == sweep.chosen and "chosen", h.td(data.short_label(sweep, p.row)),
                     h.td { class = "n", number.short(p.x) }, h.td { class = "n", number.short(p.y) } }
  end
  return h.div { class = "scroll", tabindex = "0", role = "region", ["aria-label"] = "Pareto front", h.table {
    h.thead(h.tr { h.th(data.label_head(sweep)), h.th { class = "n", metric.label .. ", ms" }, h.th { class = "n", kind.label } }), h.tbody(rows) } }
end

-- An element, and a sentence for the summary; nil when no row has an error.
return function(sweep)
  local metrics = data.metrics(sweep)
  local metric = metrics[#metrics]
  for _, kind in ipairs(ERRORS) do
    local points = metric and gather(sweep, kind, metric) or {}
    if #points > 1 then
      local front, axis = find_front(points, kind), color_axis(sweep)
      local entries = {}
      for i, value in ipairs(axis and axis.values or {}) do entries[i] = { series = i, label = value } end
      local y_low, y_high = extent(points, "y")
      local element = h.section { id = "front",
        h.h2 "Cost against error",
        h.p { class = "lead", "Each mark is a row; ", kind.up and "higher and further left" or "lower and further left",
              " is better. The line joins the rows that no other beats in both." },
        h.div { class = "pair", h.figure { axis and h.div { class = "legend", h.span { class = "quiet", axis.label }, plot.key(entries) },
          draw(sweep, points, front, kind, metric, axis, 640, 400, "wide"),
          draw(sweep, points, front, kind, metric, axis, plot.WIDTH, 320, "narrow") }, list_front(sweep, front, kind, metric) } }
      return element, string.format("%s lies between %s and %s; %s no other beats in both time and error.",
        kind.label, number.short(y_low), number.short(y_high), number.of(#front, "row"))
    end
  end
end
