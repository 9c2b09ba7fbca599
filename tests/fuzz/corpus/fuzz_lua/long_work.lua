local s = string.rep("a", 1 << 20)
for i = 1, 1e9 do local x = s < s .. "b"; s = s:upper():reverse() end
