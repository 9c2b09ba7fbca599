local x = {} for i = 1, 9 do x["a" .. i] = i / 3 end return x
