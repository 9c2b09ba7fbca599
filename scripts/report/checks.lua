-- Checks of a solver against theory: what was seen, beside what is expected, with figures and their
-- bounds. Made by tests/bench/pyro_theory.
local h, number, plot, scale = require "html", require "number", require "plot", require "scale"

-- ---- a plot ---------------------------------------------------------------------------------------

local function bounds(p)
  local b = { { math.huge, -math.huge }, { math.huge, -math.huge } }
  local logs = { p.log_x, p.log_y }
  for _, series in ipairs(p.series) do
    for _, point in ipairs(series.points) do
      for i = 1, 2 do
        if not logs[i] or point[i] > 0 then
          b[i][1], b[i][2] = math.min(b[i][1], point[i]), math.max(b[i][2], point[i])
        end
      end
    end
  end
  return b[1][2] >= b[1][1] and b or nil
end

-- What is expected is quiet and dashed, what was seen has a colour.
local function draw(series, colour, p, x, y)
  local path, marks = {}, {}
  for _, point in ipairs(series.points) do
    if (not p.log_x or point[1] > 0) and (not p.log_y or point[2] > 0) then
      local at, up = x.place(point[1]), y.place(point[2])
      path[#path + 1] = string.format("%s%.1f %.1f", #path == 0 and "M" or "L", at, up)
      marks[#marks + 1] = plot.marker(colour, at, up, series.expected and 5 or 2.6,
        string.format("%s: %s, %s", series.name, number.short(point[1]), number.short(point[2])))
    end
  end
  if series.marks then return marks end
  return h.path { class = series.expected and "front" or "line s" .. colour, d = table.concat(path) }
end

local function key(p, colours)
  local out = { class = "key" }
  for i, series in ipairs(p.series) do
    local sign = series.marks and plot.marker(colours[i], 6, 6, 4)
      or h.path { class = series.expected and "front" or "line s" .. colours[i], d = "M0 6L12 6" }
    out[i] = h.li { h.svg { class = "dot", viewBox = "0 0 12 12", ["aria-hidden"] = "true", sign }, series.name }
  end
  return h.ul(out)
end

local function figure_of(p)
  local b = bounds(p)
  if not b then return nil end
  local box = { left = plot.LEFT, right = plot.WIDTH - 12, top = plot.TOP + 12, bottom = plot.HEIGHT - plot.BOTTOM }
  local x = scale.new { low = b[1][1], high = b[1][2], from = box.left, to = box.right, log = p.log_x, ticks = 6 }
  local y = scale.new { low = b[2][1], high = b[2][2], from = box.bottom, to = box.top, log = p.log_y, zero = true, ticks = 6 }
  local svg, colours, next_colour = { plot.frame(box, x, y, p.x, p.y) }, {}, 1
  for i, series in ipairs(p.series) do
    colours[i] = series.expected and plot.SERIES or next_colour
    if not series.expected then next_colour = next_colour % (plot.SERIES - 1) + 1 end
  end
  for i, series in ipairs(p.series) do svg[#svg + 1] = draw(series, colours[i], p, x, y) end
  svg.class, svg.viewBox, svg.role = "plot", string.format("0 0 %d %d", plot.WIDTH, plot.HEIGHT), "img"
  svg["aria-label"] = string.format("%s: %s against %s", p.title, p.y, p.x)
  return h.figure { h.h4(p.title), h.svg(svg), key(p, colours) }
end

-- ---- figures --------------------------------------------------------------------------------------

local function short(value)
  return value and number.short(value) or "–"
end

local function verdict(holds)
  return h.td { class = not holds and "state" or nil, holds and "holds" or "missed" }
end

-- `check`: a cell that names it, in the table of all.
local function row_of(f, check)
  return h.tr { check, h.th { scope = "row", f.name },
    h.td { class = "n", short(f.seen) }, h.td { class = "n", short(f.wanted) },
    h.td { class = "n", short(f.low), " to ", short(f.high) }, h.td(f.unit), verdict(f.holds) }
end

local function table_of(rows, with_check)
  return h.div { class = "scroll", tabindex = "0", role = "region", ["aria-label"] = "Figures", h.table {
    h.thead(h.tr { with_check and h.th "check", h.th "figure", h.th { class = "n", "seen" }, h.th { class = "n", "expected" },
                   h.th { class = "n", "holds within" }, h.th "", h.th "" }),
    h.tbody(rows) } }
end

local function section(check)
  local rows, plots, notes = {}, { class = "panels" }, {}
  for i, f in ipairs(check.figures) do rows[i] = row_of(f) end
  for _, p in ipairs(check.plots) do plots[#plots + 1] = figure_of(p) end
  for i, note in ipairs(check.notes) do notes[i] = note .. ". " end
  return h.section { id = check.name, h.h2(check.title),
    h.p { class = "lead", check.source, ". ", notes, string.format("%s million cell steps in %s s.",
      number.short(check.million_cell_steps), number.short(check.seconds)) },
    h.div(plots), h.h3 "Figures", table_of(rows) }
end

local function tests_of(results)
  local out = {}
  for i, test in ipairs(results.tests) do
    local lines = {}
    for k, line in ipairs(test.lines) do lines[k] = h.li(line) end
    out[i] = h.section { h.h3 { test.name, test.passed and ": passed" or ": failed" }, h.ul(lines) }
  end
  return #out > 0 and h.section { id = "tests", h.h2 "What the tests compare", out }
end

-- ---- the page -------------------------------------------------------------------------------------

-- The title, and what stands in the page.
return function(results)
  local rows, sections, missed = {}, {}, 0
  for i, check in ipairs(results.checks) do
    for k, f in ipairs(check.figures) do
      rows[#rows + 1] = row_of(f, h.th { k == 1 and h.a { href = "#" .. check.name, check.title } })
      if not f.holds then missed = missed + 1 end
    end
    sections[i] = section(check)
  end
  local title = "Burning gas against theory"
  return title, {
    h.header { h.p { class = "eyebrow", "bench_pyro_theory" }, h.h1(title),
      h.p { class = "summary", string.format("%d of %s within bounds, on %s (%s), %s; %s times the coarse size.", #rows - missed,
        number.of(#rows, "figure"), results.device, results.driver, results.date, number.tick(results.fine)) } },
    #rows > 0 and table_of(rows, true), sections, tests_of(results),
    h.footer "Made from results.json beside this page." }
end
