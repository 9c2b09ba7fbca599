-- expect passes: 1
-- A user's GLSL function is a field like any other.
local fx = effect { name = "glsl" }
local turns = param { "turns", 3 }
local swirl = glsl { "support/swirl.glsl", "swirl", turns, "#ff8000" }
local spin = glsl { "support/swirl.glsl", "spin", components = 3 }
assert(tostring(swirl):find("swirl", 1, true))
assert(not pcall(glsl, { "support/swirl.glsl" }) and not pcall(glsl, { "support/swirl.glsl", "no name" }))
assert(not pcall(glsl, { "support/swirl.glsl", "spin", component = 3 }))
fx.output = march { density = sphere {} * swirl:warp(spin, 0.2), radiance = spin }
