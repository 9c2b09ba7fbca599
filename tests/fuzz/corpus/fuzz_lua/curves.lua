local function near() return true end
local fx = effect { name = "curves" }

assert(curve { { 0, 5 }, { 1, 7 } }:get() == 5)
assert(near(curve { { -1, 0 }, { 1, 10 } }:get(), 5))
assert(curve { { -1, 3 }, { 1, 10 }, shape = "step" }:get() == 3)
assert(near(curve { { -1, "#000000" }, { 1, { 1, 2, 3 } } }:get(), { 0.5, 1, 1.5 }))
assert(near(curve { { -1, 0 }, { 1, 1 }, shape = "ease_in_out" }:get(), 0.5))
curve { { 0, 0 }, { 1, 1 }, { 2, 0 }, shape = "cubic", period = 2 }

local fire = palette { { 0, "#000000" }, { 0.5, { 1, 0.4, 0 } }, { 1, "#fff3b0", 0.5 }, space = "oklab" }
local hot = palette { blackbody = { 500, 3000 }, physical = true, reference = 1500 }
local fading = palette {
  keys = {
    { 0, { { 0, "#000" }, { 1, "#fff" } } },
    { 2, { { 0, "#000" }, { 1, "#f00" } } },
  },
}
local density = perlin {} * sphere {}
march { density = density, radiance = fire(density), emission = hot(density * 3000).rgb }
march { density = density, radiance = fading(density).rgb * fire(0.5).a }
fx.output = geometry {}
