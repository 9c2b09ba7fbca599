-- Step 6: movement. Any number may be a curve of keys or a function of the time in seconds: the ball
-- bursts open and rises, the noise boils, the fire dies.
--
--   roil render effects/step-06-movement.lua --frames 28 -o movement.png

local fx = effect { name = "step_06", fps = 24, frames = 72 }

-- What you may want to turn. Each is a slider in `roil live`, and a --set of `roil render`.
local density = param { "density", 15, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local eaten   = param { "eaten", 0.6, min = 0, max = 2, help = "how much the noise eats from the ball" }
local tearing = param { "tearing", 0.35, min = 0, max = 2, unit = "m", help = "how far the flow displaces the lumps" }
local glow    = param { "glow", 60, min = 0, max = 200, help = "factor of the fire's light" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.85}, strength = 6 }
fx.sky    = sky { zenith = "#3d74b3", horizon = "#c3ced6", strength = 0.5 }

-- Fast at first, then slower and slower.
local size  = curve { {0, 0.4}, {0.4, 2.2}, {1.2, 2.9}, {3, 3.4}, shape = "cubic" }
local life  = curve { {0, 1.4}, {0.8, 1}, {2.2, 0}, shape = "ease_in_out" }
local ball  = sphere { position = function(t) return {0, 0, 1.6 + 0.9 * t} end, radius = size, falloff = size }
local flow  = curl { frequency = 0.5, octaves = 2, seed = 3, drift = {0, 0, -0.4}, speed = 0.3 }
local lumps = worley { frequency = 0.8, octaves = 4, persistence = 0.5, seed = 11, drift = {0, 0, -0.9} }:warp(flow, tearing)
local smoke = ball * smoothstep(0, 0.15, ball - eaten * (1 - lumps))
local heat  = ball * 4 * lumps * lumps * life

-- A palette makes a colour of a number: black where it is cold, nearly white where it is hottest.
local fire = palette { {0, "#000000"}, {0.25, "#300400"}, {0.5, "#c84400"}, {0.75, "#ffa020"}, {1, "#fff0b8"} }

local scene  = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}
local solid  = shade { from = scene, haze = 0.004 }
local volume = march {
  density  = smoke * density,
  emission = fire(heat) * smoke * glow,
  albedo   = {0.4, 0.4, 0.4},
  depth    = scene.depth,
}

fx.output = final { over { volume, solid }, tonemap = "reinhard" }.color
return fx
