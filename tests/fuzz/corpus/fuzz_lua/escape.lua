-- The ways out of a sandbox that are tried most often.
local fx = effect { name = "no escape" }
for _, name in ipairs { "io", "os", "debug", "package", "load", "loadfile", "dofile", "coroutine", "ffi" } do
  assert(rawget(_G, name) == nil, name)
end
assert(string.dump == nil)
local img = geometry {}
for _, object in ipairs { img, img.color, perlin {}, fx, "" } do
  assert(getmetatable(object) == false)
  assert(not pcall(setmetatable, object, {}))
  assert(not pcall(rawset, object, "x", 1))
end
assert(not pcall(setmetatable, {}, { __gc = function() end }))
assert(not pcall(require, "../fields") and not pcall(require, "/etc/passwd"))
local fake = setmetatable({}, { __name = "field", __index = perlin {} })
assert(not pcall(function() return perlin {} + fake end))
fx.output = img
