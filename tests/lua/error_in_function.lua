-- expect error: error_in_function.lua:5: attempt to perform arithmetic on a nil value
local fx = effect { name = "error" }

local function broken(t)
  return t.x * 2
end

broken {}
fx.output = geometry {}
