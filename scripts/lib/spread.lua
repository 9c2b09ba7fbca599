-- Fire, or whatever passes from one thing to the next: a forest, a fuse, a row of barrels.
--
--   local spread = require "spread"
--   local fire = spread { fx = fx, at = forest, reach = 5, wind = {3, 1, 0}, burn = {6, 9} }
--   fire:on_ignite(function(i, t) forest:set(i, { state = {1, t} }) end)
--   fx:on_click(function(event) if event.hit then fire:ignite_near(event.hit.position, 4) end end)
--
-- Each thing is normal, then burning, then burned. One that ignites looks at those within its reach, and
-- for each works out when it will have lit them: `speed` along the ground, faster with the wind and slower
-- against it. What is not lit while it burns is not lit by it at all; so fire goes out against a wind, and
-- stops at a gap that is wider than the reach. The first way by which fire comes counts: minimum travel
-- time (Finney, "Fire growth using minimum travel time methods", Canadian Journal of Forest Research 32,
-- 2002). How speed depends on the direction is an ellipse with the fire at one focus (Alexander,
-- "Estimating the length-to-breadth ratio of elliptical forest fire patterns", 1985), as long and as wide
-- as Anderson measured ("Predicting wind-driven wild land fire size and shape", 1983), by the part of the
-- wind that gets down among the trees (Albini and Baughman, "Estimating windspeeds for predicting wildland
-- fire behavior", 1979).
--
-- What is to happen lies in a queue, by its time: a frame costs what changes in it, not what there is. No
-- more than `most` changes are made in a frame; what is left over is made in the next.

local NORMAL, BURNING, BURNED = 0, 1, 2
local names = { [NORMAL] = "normal", [BURNING] = "burning", [BURNED] = "burned" }

local keys = {
  fx = "the effect", at = "instances { } or a list of {x, y, z}", reach = "m, how far it reaches",
  wind = "{x, y, z} m/s, a parameter or a function(t)", speed = "m/s without wind", gain = "of the speed, a share for each m/s of wind",
  shelter = "part of the wind that reaches the flames", lean = "s: how far the wind carries the reach", burn = "s, or {shortest, longest}", fuel = "a number, a list or function(i): factor of how long it burns; 0: never lit",
  variation = "0..1: by how much times differ", pass = "\"ignite\" or \"burned\": when it is passed on", late = "s before its end at which on_late runs",
  most = "changes in a frame", seed = "of chance",
}

local function refuse(text) error("spread: " .. text, 4) end

-- "number", "instances", "effect"; and for messages "a number", "an effect".
local function kind_of(value) return type(value) == "userdata" and tostring(value):match("^[%a ]+") or type(value) end
local function a_kind(value) return (kind_of(value):find("^[aei]") and "an " or "a ") .. kind_of(value) end

local function names_of(t)
  local sorted = {}
  for name in pairs(t) do sorted[#sorted + 1] = name end
  table.sort(sorted)
  return table.concat(sorted, ", ")
end

local function is_number(value) return type(value) == "number" and value - value == 0 end
local function is_place(p) return type(p) == "table" and is_number(p[1]) and is_number(p[2]) and (p[3] == nil or is_number(p[3])) end

local function check_keys(t)
  if type(t) ~= "table" then refuse("takes named values, as in spread { fx = fx, at = forest, reach = 5 }") end
  for key in pairs(t) do
    if not keys[key] then refuse("unknown key '" .. tostring(key) .. "'; known are " .. names_of(keys)) end
  end
  if not t.fx then refuse("'fx' is missing: the effect, as effect { } gives it") end
  if not t.at then refuse("'at' is missing: " .. keys.at) end
  if kind_of(t.fx) ~= "effect" then refuse("'fx' takes the effect, as effect { } gives it; got " .. a_kind(t.fx)) end
  if type(t.at) ~= "table" and kind_of(t.at) ~= "instances" then refuse("'at' takes " .. keys.at .. "; got " .. a_kind(t.at)) end
  local fuel = type(t.fuel)
  if fuel ~= "nil" and fuel ~= "number" and fuel ~= "table" and fuel ~= "function" then
    refuse("'fuel' takes " .. keys.fuel .. "; got " .. a_kind(t.fuel))
  end
end

local function number(t, key, otherwise, low)
  local value = t[key]
  if value == nil then return otherwise end
  if not is_number(value) or value < low then refuse("'" .. key .. "' takes a number from " .. low .. " (" .. keys[key] .. ")") end
  return value
end

local function pair(t, key, otherwise)
  local value = t[key]
  if value == nil then value = otherwise end
  if type(value) == "number" then value = { value, value } end
  if type(value) ~= "table" or type(value[1]) ~= "number" or type(value[2]) ~= "number" or not (value[1] > 0 and value[2] >= value[1]) then
    refuse("'" .. key .. "' takes " .. keys[key] .. ", above 0")
  end
  return value
end

-- ---- chance: the same for the same numbers, whatever else was asked --------------------------------

local function mix(h) -- Ettinger, "Prospecting for hash functions", 2018: lowbias32
  h = h ~ (h >> 16)
  h = h * 0x7feb352d & 0xffffffff
  h = h ~ (h >> 15)
  h = h * 0x846ca68b & 0xffffffff
  return h ~ (h >> 16)
end

local function chance(seed, a, b)
  return mix(mix(mix(seed & 0xffffffff) ~ a & 0xffffffff) ~ b & 0xffffffff) / 4294967296
end

-- ---- places: instances know their neighbours themselves; a list gets a grid -------------------------

local function list_places(list, cell)
  local grid, places = {}, {}
  local function key(x, y) return math.floor(x / cell) * 1048583 + math.floor(y / cell) end
  for i, p in ipairs(list) do
    if not is_place(p) then refuse("'at' has no place as number " .. i) end
    places[i] = { p[1], p[2], p[3] or 0 }
    local k = key(p[1], p[2])
    grid[k] = grid[k] or {}
    table.insert(grid[k], i)
  end
  if #places == 0 then refuse("'at' is empty") end
  local function near(point, radius)
    local found, far = {}, {}
    for x = math.floor((point[1] - radius) / cell), math.floor((point[1] + radius) / cell) do
      for y = math.floor((point[2] - radius) / cell), math.floor((point[2] + radius) / cell) do
        for _, i in ipairs(grid[x * 1048583 + y] or {}) do
          local p = places[i]
          local d = (p[1] - point[1]) ^ 2 + (p[2] - point[2]) ^ 2 + (p[3] - (point[3] or 0)) ^ 2
          if d <= radius * radius then
            found[#found + 1] = i
            far[i] = d
          end
        end
      end
    end
    table.sort(found, function(a, b)
      if far[a] ~= far[b] then return far[a] < far[b] end
      return a < b
    end)
    return found
  end
  return places, near
end

local function instance_places(at)
  local places = {}
  for i = 1, #at do places[i] = at:get(i).position end
  return places, function(point, radius) return at:near(point, radius) end
end

-- ---- the queue: a heap by time, then by the order in which things were put there --------------------

local function before(a, b)
  if a.time ~= b.time then return a.time < b.time end
  return a.order < b.order
end

local function push(queue, item)
  queue.order = queue.order + 1
  item.order = queue.order
  local i = #queue + 1
  while i > 1 and before(item, queue[i // 2]) do
    queue[i] = queue[i // 2]
    i = i // 2
  end
  queue[i] = item
end

local function pop(queue)
  local first, last = queue[1], table.remove(queue)
  local count, i = #queue, 1
  if count == 0 then return first end
  while true do
    local child = 2 * i
    if child > count then break end
    if child < count and before(queue[child + 1], queue[child]) then child = child + 1 end
    if not before(queue[child], last) then break end
    queue[i] = queue[child]
    i = child
  end
  queue[i] = last
  return first
end

-- ---- fire -------------------------------------------------------------------------------------------

local fire = {} -- what it can be asked to do

local function wind_at(self, t)
  local w = self.wind
  if type(w) == "function" then w = w(t) end
  if type(w) == "userdata" then w = w:get() end
  if type(w) == "number" then w = { w, 0, 0 } end
  if not is_place(w) then error("spread: 'wind' is no wind; accepted: " .. keys.wind, 0) end
  return w[1], w[2]
end

-- Speed into a direction, against that with the wind: 1 with it, least against it.
local function ellipse(wind, along)
  local u = math.min(wind * 2.237, 12) -- in miles an hour; beyond that Anderson's fires grew no longer
  local ratio = 0.936 * math.exp(0.2566 * u) + 0.461 * math.exp(-0.1548 * u) - 0.397
  local e = math.sqrt(math.max(1 - 1 / (ratio * ratio), 0))
  return (1 - e) / (1 - e * along)
end

local function tell(list, i, t)
  for _, run in ipairs(list) do run(i, t) end
end

-- Says of each neighbour when fire will have come to it.
local function pass_on(self, i, t, ends)
  local p, wx, wy = self.places[i], wind_at(self, t)
  local wind = math.sqrt(wx * wx + wy * wy)
  local center = { p[1] + self.lean * wx, p[2] + self.lean * wy, p[3] }
  for _, k in ipairs(self.near(center, self.reach)) do
    if k ~= i and self.states[k] == NORMAL and self.fuels[k] > 0 then
      local q = self.places[k]
      local x, y = q[1] - p[1], q[2] - p[2]
      local far = math.sqrt(x * x + y * y + (q[3] - p[3]) ^ 2)
      local along = far > 0 and wind > 0 and (x * wx + y * wy) / (far * wind) or 0
      local speed = self.speed * (1 + self.gain * wind) * ellipse(self.shelter * wind, along)
      local takes = far / speed * (1 + self.variation * (2 * chance(self.seed, i, k) - 1))
      if t + takes <= ends then push(self.queue, { time = t + takes, what = "ignite", index = k, from = i }) end
    end
  end
end

local function burn_out(self, i, t)
  if self.states[i] ~= BURNING then return end
  self.states[i] = BURNED
  self.burning, self.burned = self.burning - 1, self.burned + 1
  tell(self.burned_functions, i, t)
  if self.pass == "burned" then pass_on(self, i, t, math.huge) end
end

local function catch(self, i, t)
  local burns = self.fuels[i] > 0
  if self.states[i] ~= NORMAL or not burns then return false end
  local share = chance(self.seed, i, 0)
  local ends = t + (self.shortest + share * (self.longest - self.shortest)) * self.fuels[i]
  self.states[i], self.lit[i], self.ends[i] = BURNING, t, ends
  self.burning = self.burning + 1
  tell(self.ignite_functions, i, t)
  if self.late > 0 and self.late_functions[1] then
    push(self.queue, { time = math.max(ends - self.late, t), what = "late", index = i })
  end
  push(self.queue, { time = ends, what = "burned", index = i })
  if self.pass == "ignite" then pass_on(self, i, t, ends) end
  return true
end

local function run(self, t)
  local queue, left = self.queue, self.most
  self.time = t
  while left > 0 and queue[1] and queue[1].time <= t do
    local item = pop(queue)
    left = left - 1
    if item.what == "burned" then
      burn_out(self, item.index, item.time)
    elseif item.what == "late" then
      if self.states[item.index] == BURNING then tell(self.late_functions, item.index, item.time) end
    elseif self.out[item.from] or not catch(self, item.index, item.time) then
      left = left + 1 -- it was put out before, or another was faster: nothing has changed
    end
  end
end

local function begin(self)
  self.places, self.near = self.open()
  self.states, self.lit, self.ends, self.fuels, self.out = {}, {}, {}, {}, {}
  self.queue = { order = 0 }
  self.time, self.burning, self.burned = 0, 0, 0
  for i = 1, #self.places do
    self.states[i] = NORMAL
    local fuel = self.fuel
    if type(fuel) == "function" then fuel = fuel(i) elseif type(fuel) == "table" then fuel = fuel[i] end
    if fuel and not is_number(fuel) then
      error("spread: 'fuel' of " .. i .. " is " .. a_kind(fuel) .. "; a number is accepted (" .. keys.fuel .. ")", 0)
    end
    self.fuels[i] = fuel or 1
  end
end

-- Every method asks this first, so that a mistake is told of in the line that made it.
local function check(self, ...)
  if type(self) ~= "table" or not self.open then error("spread: a method is called with a colon, as in fire:ignite(1)", 3) end
  if not self.states then
    error("spread: nothing burns while the file loads; fx:on_start, on_frame, on_key and on_click can ignite", 3)
  end
  if select("#", ...) > 0 and not self.states[...] then
    error("spread: there is no number " .. tostring(...) .. "; 1 to " .. #self.places .. " are there", 3)
  end
end

-- Lights one by hand; false where it has burned, or cannot.
function fire:ignite(i)
  check(self, i)
  return catch(self, i, self.time)
end

-- The nearest to a place that can still be lit; its number, or nil where none is within the radius.
function fire:ignite_near(point, radius)
  check(self)
  if not is_place(point) or not is_number(radius) then error("spread: ignite_near takes a place and a radius, as in fire:ignite_near({1, 2, 0}, 4)", 2) end
  for _, i in ipairs(self.near(point, radius)) do
    if catch(self, i, self.time) then return i end
  end
end

-- One that burns stops at once, lights nothing any more, and counts as burned.
function fire:put_out(i)
  check(self, i)
  if self.states[i] ~= BURNING then return end
  self.out[i], self.ends[i] = true, self.time
  burn_out(self, i, self.time)
end

function fire:state(i)
  check(self, i)
  return names[self.states[i]]
end

-- How much of its fire has passed, 0..1; 0 before it.
function fire:progress(i)
  check(self, i)
  if self.states[i] == NORMAL then return 0 end
  return math.min((self.time - self.lit[i]) / (self.ends[i] - self.lit[i]), 1)
end

local numbers = { burning = true, burned = true, lit = true, ends = true } -- what it tells besides

local meta = {}
function meta.__index(_, name)
  if fire[name] then return fire[name] end
  error("spread: unknown name '" .. tostring(name) .. "'; known are " .. names_of(fire) .. ", " .. names_of(numbers), 2)
end

local function hear(list, f)
  if type(f) ~= "function" then error("spread: what is told is a function(i, t); got " .. a_kind(f), 3) end
  table.insert(list, f)
end

function fire:on_ignite(f) hear(self.ignite_functions, f) end
function fire:on_late(f) hear(self.late_functions, f) end
function fire:on_burned(f) hear(self.burned_functions, f) end

return function(t)
  check_keys(t)
  local burn, reach = pair(t, "burn", { 4, 6 }), number(t, "reach", 4, 1e-6)
  if t.pass ~= nil and t.pass ~= "ignite" and t.pass ~= "burned" then refuse("'pass' takes " .. keys.pass) end
  local self = setmetatable({
    reach = reach, wind = t.wind or { 0, 0, 0 }, speed = number(t, "speed", 1, 1e-6), gain = number(t, "gain", 0.3, 0),
    lean = number(t, "lean", 0.1, 0), shelter = number(t, "shelter", 0.3, 0), shortest = burn[1], longest = burn[2], fuel = t.fuel or 1,
    variation = math.min(number(t, "variation", 0.3, 0), 1), pass = t.pass or "ignite", late = number(t, "late", 0.5, 0),
    most = number(t, "most", 64, 1), seed = math.floor(number(t, "seed", 0, 0)), ignite_functions = {}, late_functions = {}, burned_functions = {},
    states = false, burning = 0, burned = 0, lit = {}, ends = {},
  }, meta)
  local at = t.at
  self.open = function()
    if type(at) == "table" then return list_places(at, reach) end
    return instance_places(at)
  end
  if type(at) == "table" then self.open() end -- says what is wrong while the file loads
  t.fx:on_start(function() begin(self) end)
  t.fx:on_frame(function(time) run(self, time) end)
  return self
end
