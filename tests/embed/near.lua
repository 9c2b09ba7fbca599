-- A flame that goes through the engine's wall.
local fx = effect { name = "near", fps = 24, first = 0, frames = 60 }
fx.camera = orbit { target = {0, 0, 0}, distance = 7, yaw = function(t) return 6 * t end, pitch = 10, fov = 45 }
local ball = sphere { position = {-0.4, -0.1, 0.4}, radius = 1, falloff = 0.6 } * (perlin { frequency = 1.5, drift = {0, 0, -1} } * 1.6 + 0.2)
local volume = march { density = ball * 1.5, albedo = {0, 0, 0}, emission = ball * vec(2, 0.6, 0.1), steps = 16 }
fx.output = final { volume }.color
return fx
