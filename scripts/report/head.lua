-- What was measured, where, and what came of it in a few sentences.
local data, h, number = require "data", require "html", require "number"

local function same(sweep, get)
  local first = sweep.rows[1] and get(sweep.rows[1])
  for _, row in ipairs(sweep.rows) do
    if get(row) ~= first then return nil end
  end
  return first
end

local function size_of(row)
  return row.width > 0 and string.format("%d×%d", row.width, row.height)
end

-- "28-34" of whole frames that follow each other, else a list.
local function frames_of(row)
  local frames = row.frames
  local count = #frames
  if count == 0 then return nil end
  if count > 2 and frames[count] - frames[1] == count - 1 then
    return string.format("%g–%g", frames[1], frames[count])
  end
  local parts = {}
  for i = 1, math.min(count, 8) do parts[i] = string.format("%g", frames[i]) end
  return table.concat(parts, ", ") .. (count > 8 and " …" or "")
end

-- What all rows are set to.
local function common_settings(sweep)
  local out = {}
  local first = sweep.rows[1]
  for _, name in ipairs(first and first.settings or {}) do
    local value = same(sweep, function(row) return row.settings[name] end)
    if value then out[#out + 1] = name .. " = " .. value end
  end
  return out
end

local function reference_of(sweep)
  local reference = sweep.reference
  if not reference then return nil end
  if reference.kind == "traced" then
    return "path traced" .. string.format(", %d samples a pixel", reference.samples or 0)
  end
  local parts = {}
  for _, name in ipairs(reference.settings) do parts[#parts + 1] = name .. " = " .. reference.settings[name] end
  return #parts > 0 and "a row with " .. table.concat(parts, ", ") or "a row of this sweep"
end

local function machine_of(sweep)
  local parts = {}
  if sweep.machine.cpu ~= "" then parts[1] = sweep.machine.cpu end
  if sweep.machine.cores > 0 then parts[#parts + 1] = number.of(sweep.machine.cores, "core") end
  if sweep.machine.os ~= "" then parts[#parts + 1] = sweep.machine.os end
  return table.concat(parts, ", ")
end

local function facts(sweep)
  local out = {}
  local function add(name, value)
    if value and value ~= "" then out[#out + 1] = h.div { h.dt(name), h.dd(value) } end
  end
  local frames = same(sweep, frames_of)
  local warmup, repeats = same(sweep, function(row) return row.warmup end), same(sweep, function(row) return row.repeats end)
  local others = 0
  for _, row in ipairs(sweep.rows) do others = others + (row.device and 1 or 0) end
  add("Device", sweep.device .. (others > 0 and "; " .. number.of(others, "row") .. " on others, marked below" or ""))
  add("Driver", sweep.driver)
  add("Machine", machine_of(sweep))
  add("Program", "roil " .. sweep.roil .. (sweep.commit ~= "" and ", commit " .. sweep.commit or ""))
  add("Date", (sweep.date:gsub("T", " ", 1):gsub("%.%d+", "", 1)))
  add("Effect", same(sweep, function(row) return row.effect end))
  add("Hash of all that it read", same(sweep, function(row) return row.inputs end))
  add("Picture", same(sweep, size_of))
  add("Frames", frames and frames .. (warmup and warmup > 0 and string.format(", after %d to warm up", warmup) or "")
      .. (repeats and repeats > 1 and string.format(", %d times", repeats) or ""))
  add("Errors against", reference_of(sweep))
  add("Settings", table.concat(common_settings(sweep), ", "))
  add("Sweep", sweep.file)
  return h.dl { class = "facts", out }
end

local function count_states(sweep)
  local states = { done = 0, limit = 0, failed = 0 }
  for _, row in ipairs(sweep.rows) do states[row.state] = states[row.state] + 1 end
  local text = number.of(#sweep.rows, "row") .. " on " .. sweep.device
  if states.done == #sweep.rows then return text .. (states.done > 1 and ", all done." or ", done.") end
  local parts = { states.done .. " done" }
  if states.limit > 0 then parts[#parts + 1] = states.limit .. " stopped at the time limit" end
  if states.failed > 0 then parts[#parts + 1] = states.failed .. " failed" end
  return text .. ": " .. table.concat(parts, ", ") .. "."
end

local function extremes(sweep)
  local metrics = data.metrics(sweep)
  local metric = metrics[#metrics]
  local low, high
  for _, row in ipairs(sweep.rows) do
    local spread = row.done and metric and metric.get(row)
    if spread then
      if not low or spread.median < metric.get(low).median then low = row end
      if not high or spread.median > metric.get(high).median then high = row end
    end
  end
  if not low or low == high then return nil end
  return string.format("Time of %s is %s ms (%s) to %s ms (%s).", metric.name, number.short(metric.get(low).median),
    data.full_label(low), number.short(metric.get(high).median), data.full_label(high))
end

local function failures(sweep)
  local out = {}
  for _, row in ipairs(sweep.rows) do
    if not row.done then
      out[#out + 1] = h.li { h.b(data.full_label(row)), h.br {},
        row.message ~= "" and row.message or row.state == "limit" and "stopped at its time limit" or "no message" }
    end
  end
  return #out > 0 and h.section { id = "failures", class = "failures", h.h2 "What failed", h.ul(out) }
end

-- `said`: sentences of the other parts.
return function(sweep, said)
  local sentences = { count_states(sweep), extremes(sweep) or "" }
  for _, sentence in ipairs(said) do sentences[#sentences + 1] = sentence end
  local notes = {}
  for i, note in ipairs(sweep.notes) do notes[i] = h.p { class = "note", note } end
  return { h.header { h.p { class = "eyebrow", sweep.chosen and "roil tune" or "roil bench · " .. sweep.name }, h.h1(sweep.title),
                      h.p { class = "summary", table.concat(sentences, " ") }, notes, facts(sweep) },
           failures(sweep) }
end
