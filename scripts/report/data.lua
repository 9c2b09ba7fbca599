-- The results of a sweep as the page wants them. They are checked before: every value has the type
-- that it should have. Objects come with their names, in the file's order, at 1, 2, 3 ...
local data = {}

-- Those that can be: not below 0.
local function times_of(value)
  local out = {}
  for _, name in ipairs(value) do
    if value[name].median >= 0 then out[#out + 1], out[name] = name, value[name] end
  end
  return out
end

local function row_of(value)
  return {
    index = value.index, label = value.label, axes = value.axes, effect = value.effect,
    width = value.width, height = value.height, frames = value.frames, warmup = value.warmup,
    repeats = value.repeats, settings = value.settings, state = value.state, message = value.message,
    gpu = times_of(value.gpu_ms), cpu = times_of(value.cpu_ms), times = times_of(value.times_ms), counters = value.counters,
    memory = value.memory, error = value.error or {}, published = value.published,
    device = value.device, inputs = value.inputs, picture = value.thumbnail, done = value.state == "done",
  }
end

-- ---- axes -------------------------------------------------------------------------------------

-- What stands on an axis as a number: a plain one, or the pixels of a size; and whether it is one.
local function measure_of(value)
  local width, height = value:match("^(%d+)%s*[x,]%s*(%d+)$")
  if width then return tonumber(width) * tonumber(height), true end
  local plain = tonumber(value)
  if plain and plain == plain and math.abs(plain) < 1e15 then return plain, false end
end

-- Work for a step along the axis: a picture's side has two dimensions, a volume's three.
local function dimension(name, values)
  if name == "voxels" then return 3, "voxel" end -- along a side
  if not name:find("resolution$") then return 1, nil end
  for _, value in ipairs(values) do
    if (tonumber(value) or 0) > 4 then return 3, "voxel" end
  end
  return 2, "pixel"
end

local function axis_of(value, rows)
  local axis = { name = value.name, label = value.label ~= "" and value.label or value.name, values = {}, number = {},
                 numeric = true }
  for _, row in ipairs(rows) do
    local at = row.axes[axis.name]
    if at and not axis.number[at] then
      local number, is_size = measure_of(at)
      axis.number[at] = number or 0
      axis.values[#axis.values + 1] = at
      axis.numeric = axis.numeric and number ~= nil
      axis.size = axis.size or is_size
    end
  end
  axis.numeric = axis.numeric and #axis.values > 1
  axis.dimension, axis.unit = dimension(axis.name, axis.values)
  if axis.numeric then
    table.sort(axis.values, function(a, b) return axis.number[a] < axis.number[b] end)
  end
  return axis
end

-- Axes that say of each row what an axis before them says (they were zipped) tell nothing more.
local function repeats(axis, before, rows)
  local known = {}
  for _, row in ipairs(rows) do
    local key, value = row.axes[before.name] or "", row.axes[axis.name] or ""
    known[key] = known[key] or value
    if known[key] ~= value then return false end
  end
  return true
end

function data.read(value)
  local sweep = {
    name = value.sweep, title = value.title ~= "" and value.title or value.sweep, notes = value.notes,
    file = value.file, device = value.device, driver = value.driver, machine = value.machine, roil = value.roil,
    commit = value.commit, date = value.date, reference = value.reference, rows = {}, axes = {},
    -- Rows of a search; and whether it went by processor time.
    before = value.tuned and value.tuned.before, chosen = value.tuned and value.tuned.chosen,
    by_process = value.tuned and value.tuned.by_process,
  }
  for i, row in ipairs(value.rows) do sweep.rows[i] = row_of(row) end
  for _, axis in ipairs(value.axes) do
    axis = axis_of(axis, sweep.rows)
    for _, before in ipairs(sweep.axes) do axis.zipped = axis.zipped or repeats(axis, before, sweep.rows) end
    if #axis.values > 0 then sweep.axes[#sweep.axes + 1] = axis end
  end
  return sweep
end

-- ---- what is measured ---------------------------------------------------------------------------

local function range(sweep, field, name)
  local least, greatest
  for _, row in ipairs(sweep.rows) do
    local found = row.done and row[field][name]
    if found then
      least = math.min(least or found.median, found.median)
      greatest = math.max(greatest or found.median, found.median)
    end
  end
  return least, greatest
end

-- Names of all rows, in the order of the row that has most of them.
function data.names(sweep, field)
  local longest, out, seen = {}, {}, {}
  for _, row in ipairs(sweep.rows) do
    if #row[field] > #longest then longest = row[field] end
  end
  local function add(names)
    for _, name in ipairs(names) do
      if not seen[name] then out[#out + 1], seen[name] = name, true end
    end
  end
  add(longest)
  for _, row in ipairs(sweep.rows) do add(row[field]) end
  return out
end

-- `label` heads a column, `name` stands in a sentence.
local function metric(sweep, field, key, label)
  if not range(sweep, field, key) then return nil end
  return { label = label, name = label == "whole frame" and "the whole frame" or label,
           get = function(row) return row[field][key] end }
end

-- Processor time by core, for devices that are the processor.
local function process_metric(sweep)
  local cores = math.max(sweep.machine.cores, 1)
  return { label = "processor by core", name = "a frame on all cores", get = function(row)
    local ms = row.cpu.process
    return ms and { median = ms.median / cores, p5 = ms.p5 / cores, p95 = ms.p95 / cores, count = ms.count }
  end }
end

-- Within which a time lies: its 5th and 95th percentile, and a tenth where it was measured only once.
function data.bounds(spread)
  local slack = (spread.count or 1) > 1 and 0 or 0.1 * spread.median
  return spread.p5 - slack, spread.p95 + slack
end

-- How far a time surely moves along an axis, all else being equal; without an axis, in all rows. Not
-- above 0: not beyond its spread.
local function movement(sweep, name, axis)
  local least, greatest, most = {}, {}, nil
  for _, row in ipairs(sweep.rows) do
    local found, key = row.done and row.gpu[name], {}
    if found and (not axis or row.axes[axis.name]) then
      for i, other in ipairs(axis and sweep.axes or {}) do key[i] = other == axis and "" or row.axes[other.name] or "" end
      key = table.concat(key, "\n")
      local low, high = data.bounds(found)
      least[key] = math.min(least[key] or high, high)
      greatest[key] = math.max(greatest[key] or low, low)
      local move = #sweep.rows > 1 and greatest[key] - least[key] or found.median
      most = math.max(most or move, move)
    end
  end
  return most
end

-- The pass that the sweep moves most (along an axis, if one is given), then the whole frame; or
-- whatever else was timed.
function data.metrics(sweep, axis)
  local out, main, moved = {}, nil, -math.huge
  if sweep.by_process then return { process_metric(sweep) } end
  for _, name in ipairs(data.names(sweep, "times")) do out[#out + 1] = metric(sweep, "times", name, name) end
  if #out > 0 then return out end
  for _, name in ipairs(data.names(sweep, "gpu")) do
    local move = movement(sweep, name, axis)
    if name ~= "all" and move and move > moved then main, moved = name, move end
  end
  if main then out[1] = metric(sweep, "gpu", main, main) end
  out[#out + 1] = metric(sweep, "gpu", "all", "whole frame")
  if #out == 0 then out[1] = metric(sweep, "cpu", "frame", "frame") end
  return out
end

-- ---- names of rows ------------------------------------------------------------------------------

-- A row by itself: "steps 128, resolution 0.25, perlin".
function data.full_label(row)
  return row.label ~= "" and row.label or "row " .. row.index
end

-- The axes that tell rows apart.
local function telling(sweep)
  local out = {}
  for _, axis in ipairs(sweep.axes) do
    if #axis.values > 1 and not axis.zipped then out[#out + 1] = axis end
  end
  return out
end

-- A row beside others, where there are axes to go by: "128 · 0.25 · perlin"; and what these are.
function data.short_label(sweep, row)
  local parts = {}
  for _, axis in ipairs(telling(sweep)) do parts[#parts + 1] = row.axes[axis.name] end
  return #parts > 0 and table.concat(parts, " · ") or data.full_label(row)
end

function data.label_head(sweep)
  local parts = {}
  for _, axis in ipairs(telling(sweep)) do parts[#parts + 1] = axis.label end
  return #parts > 0 and table.concat(parts, " · ") or "row"
end

return data
