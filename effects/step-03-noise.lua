-- Step 3: noise breaks the ball up. Lumps eat into it from outside, and a swirling flow tears at
-- the lumps.
--
--   roil render effects/step-03-noise.lua -o noise.png

local fx = effect { name = "step_03" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.85}, strength = 6 }
fx.sky    = sky { zenith = "#3d74b3", horizon = "#c3ced6", strength = 0.5 }

-- 0 outside, 1 in the middle: noise needs something soft to bite into.
local ball  = sphere { position = {0, 0, 2.6}, radius = 2.9, falloff = 2.9 }
local flow  = curl { frequency = 0.5, octaves = 2, seed = 3 }
local lumps = worley { frequency = 0.8, octaves = 4, persistence = 0.5, seed = 11 }:warp(flow, 0.35)
local smoke = ball * smoothstep(0, 0.15, ball - 0.6 * (1 - lumps))

local scene  = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}
local solid  = shade { from = scene, haze = 0.004 }
local volume = march { density = smoke * 15, albedo = {0.8, 0.8, 0.8}, depth = scene.depth }

fx.output = final { over { volume, solid } }.color
return fx
