-- Step 2: a ball of smoke. A field says how dense it is where, `march` draws it, and `over` lays it
-- over the scene.
--
--   roil render effects/step-02-ball.lua -o ball.png

local fx = effect { name = "step_02" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.85}, strength = 6 }
fx.sky    = sky { zenith = "#3d74b3", horizon = "#c3ced6", strength = 0.5 }

-- 0 outside, 1 from half a metre below the surface on.
local ball = sphere { position = {0, 0, 2.6}, radius = 2.2, falloff = 0.5 }

local scene  = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}
local solid  = shade { from = scene, haze = 0.004 }
local volume = march { density = ball * 4, albedo = {0.8, 0.8, 0.8}, depth = scene.depth }

fx.output = final { over { volume, solid } }.color
return fx
