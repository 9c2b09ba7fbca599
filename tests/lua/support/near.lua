-- require "support.near": near(a, b) is true for numbers, and lists of numbers, that nearly agree.
local function near(a, b)
  if type(a) == "table" then
    for i = 1, math.max(#a, #b) do
      if not near(a[i], b[i]) then return false end
    end
    return true
  end
  return math.abs(a - b) <= 1e-5 * math.max(1, math.abs(b))
end

return near
