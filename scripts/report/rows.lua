-- The table of all rows.
local data, h, number = require "data", require "html", require "number"

local function cell(spread)
  if not spread then return h.td { class = "n quiet", "–" } end
  return h.td { class = "n", number.short(spread.median),
                h.small { number.short(spread.p5), "–", number.short(spread.p95) } }
end

-- What the device uses, and below it what was reserved there and what the host uses.
local function memory(m)
  if m.device == 0 then return nil end
  return h.td { class = "n", number.bytes(m.device), m.reserved > 0 and h.small { number.bytes(m.reserved), " reserved" },
                m.host > 0 and h.small { "host ", number.bytes(m.host) } }
end

-- A column: its head, and what stands in it for a row. Those that no row fills are left out.
local function columns(sweep)
  local out = {}
  local function add(head, get, class)
    for _, row in ipairs(sweep.rows) do
      if get(row) then
        out[#out + 1] = { head = head, get = get, class = class }
        return
      end
    end
  end
  local function figure(value, form)
    return value and h.td { class = "n", (form or number.short)(value) }
  end
  for _, axis in ipairs(sweep.axes) do
    add(axis.label, function(row)
      local value = row.axes[axis.name]
      return value and h.td { class = axis.numeric and "n" or nil, value }
    end, axis.numeric and "n" or nil)
  end
  if #out == 0 then add("row", function(row) return h.td(row.label) end) end
  for _, metric in ipairs(data.metrics(sweep)) do
    add(metric.label .. ", ms", function(row) local s = metric.get(row) return s and cell(s) end, "n")
  end
  for _, name in ipairs(data.names(sweep, "published")) do
    add("published: " .. name, function(row) return figure(row.published[name]) end, "n published")
  end
  for _, name in ipairs(data.names(sweep, "cpu")) do
    add("processor: " .. name .. ", ms", function(row) return row.cpu[name] and cell(row.cpu[name]) end, "n")
  end
  for _, name in ipairs(data.names(sweep, "counters")) do
    add(name, function(row) return figure(row.counters[name], number.count) end, "n")
  end
  add("memory", function(row) return memory(row.memory) end, "n")
  add("device", function(row) return row.device and h.td { row.device } end)
  for _, kind in ipairs { { "psnr", "PSNR, dB" }, { "ssim", "SSIM" }, { "flip", "FLIP" } } do
    add(kind[2], function(row) return figure(row.error[kind[1]]) end, "n")
  end
  return out
end

local STATES = { limit = "over its time limit" }

local function state(row, span)
  local word = STATES[row.state] or row.state
  return h.td { class = "state", colspan = span, h.b(word), row.message ~= "" and ": " .. row.message }
end

local function line(sweep, row, cols, axes)
  local out = { class = row.index == sweep.chosen and "chosen" or row.index == sweep.before and "before" or not row.done and "bad",
                h.th { class = "n", scope = "row", row.index } }
  local timed = #row.gpu + #row.cpu + #row.times > 0
  for i, column in ipairs(cols) do
    if not timed and not row.done and i > axes then
      out[#out + 1] = state(row, #cols - axes)
      break
    end
    out[#out + 1] = column.get(row) or h.td { class = "n quiet", "–" }
  end
  return h.tr(out)
end

return function(sweep)
  local cols, body, axes = columns(sweep), {}, math.max(#sweep.axes, 1)
  local head = { h.th { class = "n", "#" } }
  for _, column in ipairs(cols) do head[#head + 1] = h.th { class = column.class, scope = "col", column.head } end
  for i, row in ipairs(sweep.rows) do body[i] = line(sweep, row, cols, axes) end
  return h.section { id = "rows",
    h.h2 "All rows",
    h.p { class = "lead", "Medians, and below them the 5th to the 95th percentile." },
    h.div { class = "scroll", tabindex = "0", role = "region", ["aria-label"] = "All rows",
            h.table { class = "rows", h.thead(h.tr(head)), h.tbody(body) } } }
end
