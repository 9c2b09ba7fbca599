-- A cumulus at sunset: light that is scattered hundreds of times between droplets that swallow almost
-- none of it, under a low orange sun and a sky that is still blue above.
--
--   roil render effects/cloud.lua --frames 0 -o cloud.png

local fx = effect { name = "cloud", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

local density = param { "density", 0.09, min = 0, max = 1, unit = "1/m", help = "extinction where the grid's density is 1" }
local detail  = param { "detail", 0.55, min = 0, max = 2, help = "how much the noise eats from the edges" }

local cumulus = vdb { "data/cloud.vdb", loop = "extend", offset = {0, 0, 260} }
local lumps = worley { frequency = 0.016, octaves = 4, persistence = 0.5, lacunarity = 2.2, speed = 0.02, seed = 4 }:tile()
local body  = clamp(cumulus.density * 1.4, 0, 1)
local eaten = smoothstep(0, 0.25, body - detail * (1 - lumps) * (1 - 0.8 * body))

fx.camera = camera { eye = {0, -1900, 30}, target = {0, 0, 560}, fov = 40, near = 1, far = 1e5 }
fx.sun    = sun { azimuth = 152, elevation = 5, color = {1, 0.42, 0.13}, strength = 18 }
fx.sky    = sky { zenith = {0.05, 0.13, 0.36}, horizon = {0.62, 0.27, 0.17} }

local lit = lighting {
  density    = body * eaten * density,
  albedo     = {0.995, 0.995, 0.995},
  lobes      = { {0.75, 0.8}, {0.25, -0.15} },
}
local scene  = geometry { mesh { "data/ground.obj", scale = 200, color = {0.5, 0.6, 0.8} } }
local ground = shade { from = {scene, lit}, haze = 0.00006 }
local volume = march { from = {lit, scene}, steps = 160 }

local picture = over { volume, ground, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "reinhard", exposure_ev = 0.1, saturation = 1.1 }

fx.output = shown.color
fx.linear = shown.linear
return fx
