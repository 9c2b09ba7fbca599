-- The part of an effect file's vocabulary that is said better in Lua. Runs before every effect.

-- As in GLSL: the value comes last. The methods keep it first: f:smoothstep(0.2, 0.5).
local smoothstep_of, step_of = smoothstep, step

function smoothstep(low, high, value)
  if value == nil then return smoothstep_of(low, high) end -- smoothstep { value = ..., low = ... }
  return smoothstep_of(value, low, high)
end

function step(edge, value)
  if value == nil then return step_of(edge) end
  return step_of(value, edge)
end

lerp = mix

function saturate(value)
  return clamp(value, 0, 1)
end

-- A colour from sRGB values of 0 to 255, as picture editors show them.
function rgb(red, green, blue)
  local function linear(byte)
    local v = byte / 255
    if v <= 0.04045 then return v / 12.92 end
    return ((v + 0.055) / 1.055) ^ 2.4
  end
  return { linear(red), linear(green), linear(blue) }
end
