-- From values to places along an axis: linear or logarithmic, with ticks at round numbers.
local number = require "number"

local scale = {}

local STEPS = { 1, 2, 2.5, 5, 10 }
local DECADES = { { 1 }, { 1, 3 }, { 1, 2, 5 }, { 1, 1.5, 2, 3, 5, 7 } }

local function linear_ticks(low, high, most)
  local raw = (high - low) / most
  local power = 10 ^ math.floor(math.log(raw, 10))
  local step = power * 10
  for _, factor in ipairs(STEPS) do
    if factor * power >= raw then
      step = factor * power
      break
    end
  end
  local out = {}
  for i = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) do out[#out + 1] = i * step end
  return out
end

local function decade_ticks(low, high, factors)
  local out = {}
  for decade = math.floor(math.log(low, 10)), math.ceil(math.log(high, 10)) do
    for _, factor in ipairs(factors) do
      local at = factor * 10.0 ^ decade
      if at >= low * 0.999 and at <= high * 1.001 then out[#out + 1] = at end
    end
  end
  return out
end

local function every(ticks, step)
  local out = {}
  for i = 1, #ticks, step do out[#out + 1] = ticks[i] end
  return out
end

local function log_ticks(low, high, most)
  for _, factors in ipairs(DECADES) do
    local ticks = decade_ticks(low, high, factors)
    if #ticks >= 3 then return every(ticks, math.ceil(#ticks / most)) end
  end
  return linear_ticks(low, high, most)
end

-- desc: low, high (of the data), from, to (places), log, zero (linear ones begin there), ticks (how
-- many at most). Some room is left at either end.
function scale.new(desc)
  local low, high = desc.low, desc.high
  local s = { log = desc.log }
  if s.log then
    local room = math.max((high / low) ^ 0.06, 1.03)
    low, high = low / room, high * room
  elseif desc.zero and low >= 0 then
    low, high = 0, high > 0 and high * 1.06 or 1
  else
    local room = high > low and (high - low) * 0.06 or math.max(math.abs(high), 1) * 0.1
    low, high = low - room, high + room
  end
  local function to_unit(value)
    if s.log then return math.log(value / low) / math.log(high / low) end
    return (value - low) / (high - low)
  end
  function s.place(value)
    return desc.from + (desc.to - desc.from) * to_unit(value)
  end
  s.ticks = (s.log and log_ticks or linear_ticks)(low, high, desc.ticks or 6)
  s.text = number.tick
  return s
end

-- Whether values over such a range ask for a logarithmic axis. What is next to nothing has none.
function scale.wants_log(low, high, ratio)
  return low > 1e-12 and high / low >= ratio
end

-- The exponent of the power of x that fits best (least squares of the logarithms); nil when x or y
-- is not above 0, or x does not vary.
function scale.exponent(points)
  local n, sx, sy, sxx, sxy = 0, 0, 0, 0, 0
  for _, p in ipairs(points) do
    if p.x <= 0 or p.y <= 0 then return nil end
    local x, y = math.log(p.x), math.log(p.y)
    n, sx, sy, sxx, sxy = n + 1, sx + x, sy + y, sxx + x * x, sxy + x * y
  end
  local spread = n * sxx - sx * sx
  if n < 3 or spread < 1e-9 then return nil end
  return (n * sxy - sx * sy) / spread
end

return scale
