local t = {}
for k, v in pairs({1, "a", b = 2, [true] = 3, [2.5] = 4, [false] = 1, c = {}}) do t[#t + 1] = k end
local m = setmetatable({}, { __pairs = function(s) return next, {1, 2}, nil end })
for k in pairs(m) do end
math.randomseed(3)
local a = math.random() + math.random(5) + math.random(2, 9)
local p = setmetatable({}, { __metatable = 1 })
pcall(setmetatable, p, {})
pcall(math.random, 1, 2, 3)
pcall(math.random, 9, 2)
pcall(function() return os.time() end)
return io.open("a")
