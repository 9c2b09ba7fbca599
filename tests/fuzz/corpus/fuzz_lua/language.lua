local fx = effect { name = "language", seed = 3 }
local t, n = {}, 0
for word, number in ("a=1, b=22, c=333"):gmatch("(%a)=(%d+)") do t[word] = tonumber(number) end
for k, v in pairs(t) do n = n + v + #k end
table.sort(t, function(a, b) return a < b end)
local s = ("x"):rep(10, "-"):gsub("%-", { ["-"] = "+" }):find("+", 1, true)
local ok, message = pcall(error, { code = n })
goto done
n = string.format("%5.2f %q %s", n, s, tostring(ok))
::done::
local proxy = setmetatable({}, { __index = function(_, k) return k .. n end, __call = function() return 1 end })
local x <const>, y <close> = proxy.a, setmetatable({}, { __close = function() end })
xpcall(function() local z = nil + x end, function(m) return m:upper() end)
print(utf8.char(228, 8364), math.random(1, 6), select("#", table.unpack({ 1, 2, 3 }, 2)), 7 // 2, 1 << 3)
fx.update = function(time, dt) n = n + dt end
fx.camera = orbit { yaw = function(time) return time * 30 end }
fx.output = march { density = sphere { radius = 2 } * 3, opacity = function(time) return proxy() + time end }
