-- expect passes: 2
-- Fields that do not vary in space have a value, so arithmetic can be checked here.
local near = require "support.near"
local fx = effect { name = "fields" }

local p = param { "p", 3 }
local v = param { "v", { 1, 2, 3 } }

assert(near((p + 1):get(), 4) and near((1 + p):get(), 4))
assert(near((p - 1):get(), 2) and near((1 - p):get(), -2))
assert(near((p * 2):get(), 6) and near((p / 2):get(), 1.5) and near((1 / p):get(), 1 / 3))
assert(near((p ^ 2):get(), 9) and near((-p):get(), -3))
assert(near((v * p):get(), { 3, 6, 9 }) and near((v + { 1, 1, 1 }):get(), { 2, 3, 4 }))
assert(near((v * "#ff0000"):get(), { 1, 0, 0 }))

-- Components.
assert(near(v.y:get(), 2) and near(v.zyx:get(), { 3, 2, 1 }) and near(v.r:get(), 1))
assert(near(p.xxx:get(), { 3, 3, 3 }))
assert(near((v + { p, p * 2, 0 }):get(), { 4, 8, 3 }))

-- Functions, methods, names; numbers give numbers.
assert(clamp(5, 0, 1) == 1 and near(mix(2, 4, 0.25), 2.5) and near(saturate(-1), 0))
assert(near(quantise(0.3, 4), 0.375) and near(quantise(0, 4), 0.125) and near(quantise(p, 2):get(), 3.25))
assert(near(clamp(p, 0, 1):get(), 1) and near(p:clamp(0, 2):get(), 2))
assert(near(p:clamp { high = 2.5 }:get(), 2.5) and near(clamp { p, 0, high = 2 }:get(), 2))
assert(near(remap(p, 0, 6, 0, 1):get(), 0.5) and near(p:remap(0, 6):get(), 0.5))
assert(near(min(p, 2):get(), 2) and near(max(p, 4):get(), 4) and near(p:abs():get(), 3))
assert(near(length(v):get(), 14 ^ 0.5) and near(length { 3, 4, 0 }:get(), 5))
assert(near(dot(v, { 1, 1, 1 }):get(), 6))
assert(near(smoothstep(0, 1, 0.5), 0.5) and near(smoothstep(0, 6, p):get(), 0.5))
assert(near(p:smoothstep(0, 6):get(), 0.5) and step(2, 3) == 1 and step(2, 1) == 0)
assert(near(lerp(0, p, 0.5):get(), 1.5))
assert(near(rgb(255, 0, 188), { 1, 0, 0.50288 }))

-- What fills space.
local flow = curl { frequency = 2, amount = 0.5, dimensions = 4, speed = 1 }
local cells = worley { 3, octaves = 2, distance = "f2_f1", power = p }:warp(flow, 0.2)
local shape = sphere { radius = 1, falloff = 0.2 } * cells + box { size = { 1, 2, 3 } } * 0.5
local moved = shape:transform { translate = { 0, 0, function(t) return t end }, scale = 2 }
local field = mix(moved, perlin { seed = 4, drift = { 0, 0, 1 } }, 0.5) * max(0, position.z) * sphere {}
assert(tostring(field):find("worley", 1, true))
local carried = (cells + perlin { 2, w = function(t) return t * t end }):advect(flow, { period = 2, phases = "3" })
field = field + sphere {} * carried * advect { value = cells, velocity = { 0, 0, 1 }, path = "curved" }
assert(not pcall(advect, cells)) -- needs a velocity
assert(floor(2.7) == 2 and near(fract(2.7), 0.7) and near(fract(p):get(), 0))
assert(getmetatable(field) == false)

march { density = field, radiance = field * v, opacity = p }

fx.output = march { density = sphere {} * time, name = "shown" }
