local t = {}
for i = 1, 100 do t[i] = string.rep("a", (1 << 20) + i) end
