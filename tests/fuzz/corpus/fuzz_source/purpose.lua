local hot = splats { name = "x", size = 2 * param { "a", 1 }, k = f(param({ 1 })) }
fx.output = final { g = function() return param { "b" } end }
local a <const> = param { "c" }