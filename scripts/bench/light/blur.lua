-- A jet of smoke, alone in the light of the sun and of a sky of one colour: `blur` beside this file draws it here and
-- in Blender's path tracer (Cycles 3.4), with and without motion blur.

local fx = effect { name = "blur", fps = 24, frames = 24 }

local air = lbm { size = {32, 32, 64}, voxel_size = 0.0625, speed = 9 }
local lumps = perlin { frequency = 3, speed = 6, octaves = 2, seed = 2 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.35 }, density = smoothstep(-0.2, 0.4, lumps),
             velocity = vec(4, 0, 8), rate = 60 }

fx.camera = camera { eye = {0, -9, 2}, target = {0, 0, 2}, fov = 26, near = 0.1, far = 100 }
fx.sun    = sun { azimuth = 239.0, elevation = 44.09, strength = 2.5, angle = 1.146 }
fx.sky    = sky { zenith = {0.22, 0.32, 0.48}, horizon = {0.22, 0.32, 0.48}, strength = 0.6 }

local lit = lighting { density = air.density * 8, albedo = {0.45, 0.43, 0.41}, anisotropy = 0.2, sampling = "linear" }
local shown = final { march { from = lit, steps = 192 }, tonemap = "none" }

fx.output = shown.color
fx.linear = shown.linear
return fx
