local t = string.rep("a", 1 << 20)
pcall(function() t = t:rep(5) t = t:rep(5) end)
pcall(function() t = t .. t:rep(9) end)
local n = {}
for i = 1, 1e5 do n[i] = i end
