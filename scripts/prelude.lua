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

-- The middle of the step that a value lies in, of `steps` from 0 to 1: bands instead of shades.
function quantise(value, steps)
  if not steps or steps == 0 then error("quantise takes a value and how many steps it gets, as in quantise(position.z, 4)", 2) end
  return (floor(value * steps) + 0.5) / steps
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

-- over_age { {0, 0.01}, {0.2, 0.1}, {1, 0} }: a number or a colour over a particle's life (0..1).
local ramp_over_age = over_age

function over_age(keys)
  local function wrong(what)
    error("over_age takes 2 to 64 keys {age, value}, as in over_age { {0, 0.01}, {1, 0.1} }; " .. what, 3)
  end
  if type(keys) ~= "table" or #keys < 2 then wrong("got " .. (type(keys) == "table" and #keys or "a " .. type(keys))) end
  local stops, number = {}, type(keys[1]) == "table" and type(keys[1][2]) == "number"
  for i, key in ipairs(keys) do
    if type(key) ~= "table" or #key ~= 2 or (type(key[2]) == "number") ~= number then wrong("number " .. i .. " is none, or no value like the first") end
    stops[i] = { key[1], number and { key[2], key[2], key[2] } or key[2] }
  end
  local value = ramp_over_age(stops, number)(particle_age)
  return number and value.r or value.rgb
end

-- layers { {scale, strength}, ... }: the layered noise of a layered explosion (Avalos 2019, section 2),
-- 0..1: the sum over the layers of noise at `scale` times `strength`, divided by all strengths. One
-- layer of gradient noise alone looks too soft: its lumps are all of one size and as high as deep.
-- A second, finer layer breaks their outline, which is what makes a ball of noise look like a burst;
-- more layers cost as much each and show less.
--
-- dimensions = 3: the noise fills space; of a shell: it is taken at the unit sphere. 2: it is a
-- picture wrapped around the origin, as published: it shrinks to a point at both poles, and scales are
-- rounded so that it closes behind. `shift`, 0..1, moves it: shell_shift, so that no two shells look
-- alike. Other keys are those of the noise: seed, speed, octaves, fractal.
local numbers_of = layers -- a copy of its table in which numbers are controls (l_layers.c)

local function layers_wrong(what)
  error("layers takes 1 to 64 pairs {scale, strength}, as in layers { {2, 1}, {7, 0.4} }; " .. what, 3)
end

local function whole_cells(scale)
  if type(scale) == "number" then return math.max(math.floor(scale + 0.5), 1) end
  return max(floor(scale + 0.5), 1)
end

local function one_layer(settings, number, scale, flat)
  local own = {}
  for key, value in pairs(settings) do
    if type(key) == "string" and key ~= "dimensions" and key ~= "noise" and key ~= "shift" then own[key] = value end
  end
  own.octaves = settings.octaves or 1 -- where there are too many lists
  own.seed = (settings.seed or 0) + 17 * (number - 1)
  own.frequency = flat and whole_cells(scale) or scale
  if flat then own.period = own.frequency end
  return (settings.noise or perlin)(own)
end

function layers(settings)
  if type(settings) ~= "table" then layers_wrong("got a " .. type(settings)) end
  if #settings < 1 or #settings > 64 then layers_wrong("got " .. #settings .. " of them") end
  local flat, sum, all = settings.dimensions == 2, 0, 0
  if not (flat or settings.dimensions == nil or settings.dimensions == 3) then layers_wrong("'dimensions' is 2 or 3") end
  if type(settings.noise or perlin) ~= "function" then layers_wrong("'noise' is perlin, simplex, value or worley, as in noise = worley") end
  for i, layer in ipairs(settings) do
    if type(layer) ~= "table" or #layer ~= 2 or type(layer[1]) == "string" or type(layer[2]) == "string" then layers_wrong("number " .. i .. " is none") end
  end
  settings = numbers_of(settings)
  for i, layer in ipairs(settings) do
    sum = sum + one_layer(settings, i, layer[1], flat) * layer[2]
    all = all + layer[2]
  end
  local noise, shift = sum / all, settings.shift or shell_shift
  if type(shift) == "table" then shift = vec(shift[1], shift[2], shift[3]) end
  if not flat then return noise:warp(61 * shift) end
  local across = atan(position.y, position.x) / (2 * math.pi)
  local up = atan(position.z, length(vec(position.x, position.y, 0))) / math.pi
  return noise:warp(vec(across + 0.5, up + 0.5, 0) + 16 * shift - position)
end

-- blast { position = {0, 0, 1}, time = 0.2, charge = 1 }: a burst as an event. Its fields are made when
-- they are asked for.
local blast_keys = { position = true, time = true, charge = true }

function blast(settings)
  local function wrong(what)
    error("blast takes position, time and charge, as in blast { position = {0, 0, 1}, time = 0.2, charge = 1 }; " .. what, 3)
  end
  if type(settings) ~= "table" then wrong("got a " .. type(settings)) end
  for key in pairs(settings) do
    if not blast_keys[key] then wrong(type(key) == "string" and "'" .. key .. "' is none of them" or "a value has no name") end
  end
  local place, charge, start = settings.position, settings.charge, settings.time or 0
  if type(start) ~= "number" and type(start) ~= "userdata" then wrong("'time' is seconds, a parameter or a field; got a " .. type(start)) end
  local make = {
    pressure = function() return blast_pressure { position = place, charge = charge, age = time - start } end,
    velocity = function() return blast_velocity { position = place, charge = charge, age = time - start } end,
    impulse = function() return blast_impulse { position = place, charge = charge } end,
    arrival = function() return start + blast_arrival { position = place, charge = charge } end,
  }
  return setmetatable({}, {
    __index = function(_, name)
      if not make[name] then error("blast: no field '" .. tostring(name) .. "'; it has pressure, velocity, impulse and arrival", 2) end
      return make[name]()
    end,
    __newindex = function(_, name) error("blast." .. tostring(name) .. " cannot be set; say it in blast { }", 2) end,
  })
end

-- lobes = { {weight, g}, ... } of the passes that scatter light: a blend of lobes.
local function value_at(value, t)
  if type(value) == "function" then return value(t) end
  if type(value) == "userdata" then return value:get() end
  return value
end

-- Four numbers; a function of time if any of them moves.
local function four(values)
  local moves = false
  for i = 1, 4 do moves = moves or type(values[i]) ~= "number" end
  if not moves then return values end
  return function(t)
    local now = {}
    for i = 1, 4 do now[i] = value_at(values[i], t) end
    return now
  end
end

local function expand_lobes(pass, settings)
  local function wrong(what)
    error(pass .. ": 'lobes' takes 1 to 4 pairs {weight, g}, as in { {2, 0.8}, {1, -0.3} }; " .. what, 4)
  end
  local lobes = settings.lobes
  if type(lobes) ~= "table" then wrong("got a " .. type(lobes)) end
  if #lobes < 1 or #lobes > 4 then wrong("got " .. #lobes .. " of them") end
  local weights, anisotropies = { 0, 0, 0, 0 }, { 0, 0, 0, 0 }
  local accepted = { number = true, userdata = true, ["function"] = true }
  for i, lobe in ipairs(lobes) do
    if type(lobe) ~= "table" or #lobe ~= 2 or not (accepted[type(lobe[1])] and accepted[type(lobe[2])]) then wrong("number " .. i .. " is none") end
    weights[i], anisotropies[i] = lobe[1], lobe[2]
  end
  if settings.lobe_weights or settings.lobe_anisotropies then
    wrong("'lobe_weights' and 'lobe_anisotropies' say the same, give either")
  end
  local expanded = {}
  for key, value in pairs(settings) do
    if key ~= "lobes" then expanded[key] = value end
  end
  expanded.lobe_weights, expanded.lobe_anisotropies = four(weights), four(anisotropies)
  return expanded
end

for _, name in ipairs { "march", "lighting", "reference" } do
  local make = rawget(_G, name)
  if make then
    _G[name] = function(...)
      local arguments, count = { ... }, select("#", ...)
      local settings = arguments[count]
      if type(settings) == "table" and settings.lobes ~= nil then
        arguments[count] = expand_lobes(name, settings)
      end
      return make(table.unpack(arguments, 1, count))
    end
  end
end
