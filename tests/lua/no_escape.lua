-- expect error: march failed, and the file went on
-- The ways out of a sandbox that are tried most often.
local fx = effect { name = "no escape" }
for _, name in ipairs { "io", "os", "debug", "package", "load", "loadfile", "dofile", "coroutine", "ffi" } do
  assert(rawget(_G, name) == nil, name)
end
assert(string.dump == nil)
local img = geometry {}
for _, object in ipairs { img, img.depth, perlin {}, fx, "" } do
  assert(getmetatable(object) == false)
  assert(not pcall(setmetatable, object, {}))
  assert(not pcall(rawset, object, "x", 1))
end
assert(not pcall(setmetatable, {}, { __gc = function() end }))
assert(not pcall(require, "../fields") and not pcall(require, "/etc/passwd"))
local fake = setmetatable({}, { __name = "field", __index = perlin {} })
assert(not pcall(function() return perlin {} + fake end))

-- Settings that change while they are read, or that answer by a function, do no harm.
local ball = sphere {}
local hostile = { density = ball, opacity = false, steps = 32 }
hostile.opacity = function()
  for k in pairs(hostile) do hostile[k] = nil end
  for i = 1, 1000 do hostile["x" .. i] = ("y"):rep(100) end
  assert(not pcall(param, { "late", 1 }) and not pcall(march, { density = ball }))
  return 1
end
local done, message = pcall(march, hostile)
assert(not done and message:find("march: 'steps' must be a number", 1, true), message)
setmetatable(hostile, { __index = function() error "never asked" end })
pcall(sphere, hostile)
fx.output = img
