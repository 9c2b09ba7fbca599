-- Numbers as people read them.
local number = {}

-- "12 688": narrow no-break spaces between thousands.
local function group(text)
  local whole, rest = text:match("^(%-?%d+)(.*)$")
  if not whole or #whole < 5 then return text end
  local first = #whole % 3
  local parts = { first > 0 and whole:sub(1, first) or nil }
  for i = first + 1, #whole, 3 do parts[#parts + 1] = whole:sub(i, i + 2) end
  return table.concat(parts, "\u{202f}") .. rest
end

-- Three figures or more: 0.00131, 0.0360, 1.56, 40.4, 12 688.
function number.short(value)
  local size = math.abs(value)
  if size >= 1e12 or (size > 0 and size < 1e-4) then return string.format("%.1e", value) end
  local places = size < 1 and math.min(2 - math.floor(math.log(math.max(size, 1e-9), 10)), 6) or size < 10 and 2 or size < 100 and 1 or 0
  return group(string.format("%." .. (size == 0 and 0 or places) .. "f", value))
end

-- At a tick of an axis: no more places than it takes.
function number.tick(value)
  if value ~= 0 and (math.abs(value) >= 1e7 or math.abs(value) < 1e-4) then
    return (string.format("%.0e", value):gsub("e([+-])0*", "e%1"):gsub("e%+", "e"))
  end
  return group(string.format("%.10g", tonumber(string.format("%.6g", value))))
end

function number.count(value)
  local size = math.abs(value)
  if size >= 1e9 then return number.short(value / 1e9) .. " G" end
  if size >= 1e6 then return number.short(value / 1e6) .. " M" end
  if size >= 1e4 then return number.short(value / 1e3) .. " k" end
  return number.tick(value)
end

function number.bytes(value)
  if value >= 2 ^ 30 then return number.short(value / 2 ^ 30) .. " GiB" end
  if value >= 2 ^ 20 then return number.short(value / 2 ^ 20) .. " MiB" end
  return number.short(value / 2 ^ 10) .. " KiB"
end

-- "1 row", "3 rows"
function number.of(count, noun)
  return string.format("%s %s%s", group(tostring(count)), noun, count == 1 and "" or "s")
end

return number
