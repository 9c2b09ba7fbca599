-- The same burst at night, in a freight yard: the only lights are a moon, two lamps, and the fire
-- itself, which throws the shadows of everything that stands around it and dies with the flames.
--
--   roil render effects/night.lua --frames 22 -o night.png

local fx = effect { name = "night", fps = 24, frames = 100, author = "the roil authors", licence = "MIT" }

local density    = param { "density", 46, min = 0, max = 200, unit = "1/m", help = "extinction where the grid's density is 1" }
local brightness = param { "brightness", 26, min = 0, max = 100, help = "factor of the fire's light" }
local kelvin     = param { "kelvin", 1330, min = 500, max = 3000, unit = "K", help = "temperature where the grid says 1" }
local detail     = param { "detail", 1.6, min = 0, max = 3, help = "how much the noise eats from the smoke's edges" }
local turbulence = param { "turbulence", 0.27, min = 0, max = 2, unit = "m", help = "how far the flow displaces the grid" }

local burst = vdb { "data/explosion-32/*.vdb", fps = 24, blend = true }
local flow  = bake(curl { frequency = 0.7, octaves = 2, persistence = 0.6, speed = 0.4, seed = 5 },
                   { size = {48, 48, 48}, box = burst.box })
local torn  = bake(vec(burst.density, burst.temperature, burst.flame):warp(flow, turbulence),
                   { size = {80, 80, 80}, box = burst.box })
local smoke, heat, flame = torn.x, torn.y, torn.z

local lumps = worley({ frequency = 1.4, octaves = 5, persistence = 0.66, lacunarity = 2.1,
                       drift = {0, 0, -0.5}, seed = 29 }):tile { resolution = 128, octaves = 2 }:warp(flow, 0.25)
local cover = clamp(smoke * 2.2, 0, 1)
local crust = smoothstep(0, 0.15, cover - detail * (1 - lumps) * (1 - 0.6 * cover))

-- A black body is white where it is very hot. After a flash it is shown colder than it is, and brighter, so
-- that it keeps its colour and its folds.
local young = curve { {0, 1.3}, {0.09, 0.95}, {0.2, 0.62}, {0.4, 0.68}, {0.8, 0.76}, {1.25, 0.8}, {2, 1}, shape = "ease_in_out" }
local fire  = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }

fx.camera = camera { eye = {2.6, -5.6, 1.5}, target = {4.2, 4, 3.1}, fov = 47, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 60, elevation = 32, color = {0.55, 0.7, 1}, strength = 0.12 } -- the moon
fx.sky    = sky { zenith = {0.012, 0.022, 0.054}, horizon = {0.045, 0.05, 0.09} }
fx.lights = {
  spot_light { position = {-3.5, 9.6, 4.4}, target = {-3.0, 7.5, 0}, color = {1, 0.72, 0.40}, power = 1000, angle = 110, softness = 0.6, radius = 0.1 },
  spot_light { position = {12.0, 9.6, 4.4}, target = {11.5, 7.5, 0}, color = {1, 0.72, 0.40}, power = 1000, angle = 110, softness = 0.6, radius = 0.1 },
}

local lit = lighting {
  density    = cover * crust * (smoke + 0.15) * density,
  emission   = fire(heat * (0.15 + 1.35 * lumps) * kelvin * young) * flame * brightness,
  albedo     = {0.45, 0.43, 0.41},
  anisotropy = 0.2,
  sampling   = "linear",
}

local scene = geometry { mesh { "data/ground.obj" }, mesh { "data/yard.obj" } }
local solid = shade { from = {scene, lit}, shadow_samples = 4 }
local volume = march { from = {lit, scene}, steps = 128, resolution = 0.5 }

local picture = over { volume, solid, from = {volume, scene} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.8 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.22, exposure_ev = 0.9, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
