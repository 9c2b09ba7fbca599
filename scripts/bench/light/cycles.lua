-- The scene that Blender's path tracer (Cycles 3.4) rendered, number for number: one frame of a baked
-- explosion in grey smoke, ground, sun and a sky of one colour. `cycles` beside this file puts the
-- frame where it is looked for, and compares.

local fx = effect { name = "cycles", fps = 24, frames = 1 }

-- Blender draws a voxel from its index on, where OpenVDB has its middle: half of 0.0625 m.
local burst = vdb { "data/frame.vdb", loop = "extend", offset = {0.03125, 0.03125, 0.03125} }

fx.camera = camera { eye = {4, -12, 3.36}, target = {4, 4, 3.36}, fov = 31.8908, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239.0, elevation = 44.09, strength = 2.5, angle = 1.146 }
fx.sky    = sky { zenith = {0.22, 0.32, 0.48}, horizon = {0.22, 0.32, 0.48}, strength = 0.6 }

local lit = lighting {
  density = burst.density * 16,
  albedo = {0.45, 0.43, 0.41},
  anisotropy = 0.2,
  temperature = burst.temperature * 900,
  blackbody_intensity = burst.flame * 12,
  sampling = "linear", -- as Cycles
}
local scene   = geometry { mesh { "data/plane.obj", position = {4, 4, 0.16} } }
local solid   = shade { from = {scene, lit} }
local volume  = march { from = {lit, scene}, steps = 256 }
local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "agx" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
