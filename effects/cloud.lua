-- A cumulus at sunset: light that is scattered hundreds of times between droplets that swallow almost
-- none of it, under a low orange sun and a sky that is still blue above.
--
--   roil render effects/cloud.lua --frames 0 -o cloud.png

local fx = effect { name = "cloud", fps = 24, frames = 240 }

local density = param { "density", 0.09, min = 0, max = 1, unit = "1/m", help = "extinction where the grid's density is 1" }
local detail  = param { "detail", 0.55, min = 0, max = 2, help = "how much the noise eats from the edges" }

local cumulus = vdb { "data/cloud.vdb", loop = "extend" }
local lumps = worley { frequency = 0.016, octaves = 4, persistence = 0.5, lacunarity = 2.2, speed = 0.02, seed = 4 }
local body  = clamp(cumulus.density * 1.4, 0, 1)
local eaten = smoothstep(0, 0.25, body - detail * (1 - lumps) * (1 - 0.8 * body))

fx.camera = camera { eye = {0, -1900, 60}, target = {0, 0, 430}, fov = 34, near = 1, far = 1e5 }
fx.sun    = sun { azimuth = 172, elevation = 9, color = {1, 0.50, 0.20}, strength = 7 }
fx.sky    = sky { zenith = {0.10, 0.17, 0.36}, horizon = {0.62, 0.36, 0.26} }

local lit = lighting {
  density    = body * eaten * density,
  albedo     = {0.995, 0.995, 0.995},
  lobes      = { {0.75, 0.8}, {0.25, -0.15} },
  sweeps     = 12,
}
local scene  = geometry {}
local sky    = shade { from = {scene, lit} }
local volume = march { from = {lit, scene}, steps = 160 }

local picture = over { volume = volume.color, edge = volume.edge, source = sky, depth = scene.depth }
local shown   = final { source = picture, tonemap = "agx", exposure_ev = 0.6, saturation = 1.15 }

fx.output = shown.color
fx.linear = shown.linear
return fx
