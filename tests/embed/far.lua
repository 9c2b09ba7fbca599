-- A cloud of smoke behind the engine's wall, in the light of a sun.
local fx = effect { name = "far", fps = 24, first = 0, frames = 60 }
fx.camera = orbit { target = {0, 0, 0}, distance = 7, yaw = function(t) return 6 * t end, pitch = 10, fov = 45 }
fx.sun = sun { azimuth = 200, elevation = 35, strength = 4 }
local smoke = sphere { position = {-0.6, 1.5, 0.9}, radius = 1.4 } * (perlin { frequency = 1.5 } + 0.7)
local volume = march { density = smoke * 2.5, albedo = {0.8, 0.7, 0.6}, steps = 16, shadow_steps = 4 }
fx.output = final { volume }.color
return fx
