-- A ball of fire of noise alone: nothing is simulated, so it is quick to draw and to change.
local fx = effect { name = "burst", fps = 24, frames = 72, author = "the roil authors", licence = "MIT" }

local density = param { "density", 12, min = 0, max = 200, unit = "1/m", help = "how thick it is" }
local glow    = param { "glow", 3, min = 0, max = 50, help = "factor of its light" }
local torn    = param { "torn", 0.8, min = 0, max = 2, help = "how much the noise eats from it" }
local growth  = curve { {0, 0.2}, {0.3, 0.9}, {3, 1.3}, shape = "ease_out" }
local heat    = curve { {0, 1}, {0.5, 0.9}, {2.5, 0.1}, shape = "linear" }
local fire    = palette { {0, "#000000"}, {0.35, "#7a1500"}, {0.7, "#ff8a20"}, {1, "#fff3b0"} }

local lumps = worley { frequency = 1.6, octaves = 4, persistence = 0.55, drift = {0, 0, 0.6} }
              :warp(curl { frequency = 1, octaves = 2 }, 0.3)
local ball  = sphere { position = {0, 0, 1.4}, radius = growth, falloff = 0.8 }
local body  = smoothstep(0, 0.25, ball - torn * (1 - lumps) * (1 - 0.6 * ball)) * ball

fx.camera = orbit { target = {0, 0, 1.4}, distance = 6, pitch = 6 }
fx.sun    = sun { azimuth = 240, elevation = 40, strength = 3 }

local lit    = lighting { density = body * density, emission = fire(lumps * heat).rgb * body * glow * 14, albedo = 0.4 }
local volume = march { from = {lit}, steps = 96 }

fx.output = final { source = volume, tonemap = "aces" }.color
return fx
