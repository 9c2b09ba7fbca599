local fx = effect { name = "a" }
local f = sphere { radius = function(t) return t > 1 and "x" or t > 0.5 and 1 / 0 or 1 end }
fx.output = final { march { density = f, steps = function(t) return {1, 2} end } }.color
return fx
