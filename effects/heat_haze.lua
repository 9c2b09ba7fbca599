-- A shader of your own as a pass: heat_haze.comp bends the picture above a fire. What the shader
-- declares (its inputs, outputs and uniforms) is set here like that of any built-in pass.
--
--   roil render effects/heat_haze.lua --frames 24 -o haze.png --set heat_haze.strength=0.03

local fx = effect { name = "heat_haze", fps = 24, frames = 48, author = "the roil authors", licence = "MIT" }

-- A fire made of shapes and noise alone: no file is needed.
local tongue = capsule { from = {0, 0, 0.2}, to = {0, 0, 1.9}, radius = 0.75, falloff = 0.75 }
local flicker = perlin { frequency = 1.1, octaves = 3, drift = {0, 0, -2.4}, speed = 0.8, seed = 5 }
local sway    = curl { frequency = 0.7, drift = {0, 0, -1.5}, seed = 2 }
local body    = (tongue * smoothstep(0.38, 0.62, flicker)):warp(sway, 0.10)

local colors = palette {
  space = "oklab",
  keys = { -- the fire burns down: its palette moves from hot to cold
    { 0.0, { {0, "#000000"}, {0.25, "#a02000"}, {0.6, "#ff8a10"}, {1, "#fff2c0"} } },
    { 2.0, { {0, "#000000"}, {0.25, "#601000"}, {0.6, "#d04000"}, {1, "#ffb050"} } },
  },
}

fx.camera = orbit { target = {0, 0, 1.1}, distance = 7, pitch = 6, yaw = curve { {0, -12}, {2, 12}, shape = "ease_in_out" }, fov = 36 }
fx.sky    = sky { zenith = {0.02, 0.03, 0.07}, horizon = {0.10, 0.08, 0.09}, strength = 1 }
fx.sun    = sun { strength = 0.25, elevation = 12, azimuth = 200 }

local scene  = geometry { mesh { "data/ground.obj" } }
local lit    = lighting {
  density = body * 3, radiance = colors(body * 1.5) * 3, albedo = {0.3, 0.3, 0.3},
  glow_resolution = 16, shadow_resolution = 48,
}
local solid  = shade { from = {scene, lit}, haze = 0.01 } -- the fire lights the ground
local volume = march { from = {lit, scene}, steps = 96, resolution = 0.5 }
local picture = over { volume, solid, from = {volume, scene} }
local bent    = shader { "heat_haze.comp", input = picture, heat = tongue, strength = 0.012 }
local shown   = final { source = bent, bloom = bloom { bright { bent } }, bloom_intensity = 0.5, tonemap = "reinhard" }

fx.output = shown.color
fx.linear = shown.linear
return fx
