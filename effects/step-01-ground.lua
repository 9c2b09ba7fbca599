-- Step 1: an effect that is only a picture: ground, sky, sun and a camera. No smoke yet.
--
--   roil render effects/step-01-ground.lua -o ground.png

local fx = effect { name = "step_01" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.85}, strength = 6 }
fx.sky    = sky { zenith = "#3d74b3", horizon = "#c3ced6", strength = 0.5 }

local scene = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}
local solid = shade { from = scene, haze = 0.004 }

fx.output = final { solid }.color
return fx
