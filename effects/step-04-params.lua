-- Step 4: the numbers worth turning get a name, a range and a unit.
--
--   roil render effects/step-04-params.lua --set density=40 --set eaten=0.9 -o params.png

local fx = effect { name = "step_04" }

-- What you may want to turn. Each is a slider in `roil live`, and a --set of `roil render`.
local density = param { "density", 15, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local eaten   = param { "eaten", 0.6, min = 0, max = 2, help = "how much the noise eats from the ball" }
local tearing = param { "tearing", 0.35, min = 0, max = 2, unit = "m", help = "how far the flow displaces the lumps" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.85}, strength = 6 }
fx.sky    = sky { zenith = "#3d74b3", horizon = "#c3ced6", strength = 0.5 }

-- 0 outside, 1 in the middle: noise needs something soft to bite into.
local ball  = sphere { position = {0, 0, 2.6}, radius = 2.9, falloff = 2.9 }
local flow  = curl { frequency = 0.5, octaves = 2, seed = 3 }
local lumps = worley { frequency = 0.8, octaves = 4, persistence = 0.5, seed = 11 }:warp(flow, tearing)
local smoke = ball * smoothstep(0, 0.15, ball - eaten * (1 - lumps))

local scene  = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}
local solid  = shade { from = scene, haze = 0.004 }
local volume = march { density = smoke * density, albedo = {0.8, 0.8, 0.8}, depth = scene.depth }

fx.output = final { over { volume, solid } }.color
return fx
