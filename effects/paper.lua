-- The explosion of Raseta, Lesar and Bohak, "Real-time volumetric explosion special effects for
-- games" (2025), as published: its march, its noises, its numbers. For comparing figures and looks;
-- effects/explosion.lua is what roil makes of the same data.
--
--   roil render effects/paper.lua --frames 10,30,50,70
--   roil render effects/paper.lua --frames 30 --size 1920x1080 --set noise=perlin --set steps=64 --set march.resolution=0.5

local fx = effect { name = "paper", fps = 24, frames = 100, author = "the roil authors", licence = "MIT" }

local steps   = param { "steps", 128, min = 1, max = 1024, integer = true, help = "16, 32, 64, 128 or 256 in the paper" }
local opacity = param { "opacity", 20, min = 0, max = 40, help = "volume density, section 4" }
local noise   = param { "noise", "worley_curl", words = {"perlin", "worley", "worley_curl", "none"}, help = "section 3.7" }
local noise_bake = param { "noise_bake", "tile", words = {"tile", "exact"}, help = "exact computes the noise at every sample, tile once, in voxels" }
local show    = param { "show_noise", false, help = "the noise itself, on the faces of the box" }

local burst = vdb { "data/explosion-32/*.vdb", fps = 24 }
local side  = burst.box.max[1] - burst.box.min[1]

-- The paper's noises live in the box's own coordinates, 0 to 1, and slide through it. As a tile they
-- are computed once, over twice the box, which they leave after five seconds only: within, the tile is
-- the noise itself.
local drift = {0.1, 0.15, 0.2}
local function baked(detail, frequency)
  if noise_bake:get() == "exact" then return detail end
  return detail:tile { resolution = 96, cells = 2 * frequency, octaves = 2 }
end
local kinds = {
  perlin = function() return baked(perlin { frequency = 4, octaves = 2, persistence = 0.5, lacunarity = 2, drift = drift }, 4) end,
  worley = function() return baked(worley { mode = "paper", frequency = 10, power = 1.5, drift = drift }, 10) end,
  worley_curl = function()
    -- Its domain is the box times ten: a step of 0.01 and a factor of 5 there are a tenth here.
    local swirl = curl { mode = "paper", frequency = 10, step = 0.001, drift = drift }
    return baked(worley { mode = "paper", frequency = 10, power = 1.5, drift = drift }:warp(swirl, 0.5), 10)
  end,
  none = function() return 1 end,
}
local detail = kinds[noise:get()]()
if noise:get() ~= "none" then detail = detail:transform { scale = side } end

-- Noise is blended in by 50 % into the density and by 30 % into the temperature.
local density     = burst.density * mix(1, detail, 0.5)
local temperature = burst.temperature * (1 / 3.5) * mix(1, detail, 0.3)

-- Its palette is a texture of six texels, of which the hot ones are brighter than a screen shows: bloom
-- lives on them. Smoke is grey. A colour is weighed by the density once more than its opacity says.
local texels = { {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}, {1.5, 0.4, 0.4}, {1.8, 1.2, 0.1}, {2, 2, 0.8} }
local stops = {}
for i, color in ipairs(texels) do stops[i] = {(i - 0.5) / #texels, color} end
local colors = palette(stops)(temperature) * density

fx.camera = camera { eye = {4, -12, 3.36}, target = {4, 4, 3.36}, fov = 31.89, near = 0.1, far = 500 }
-- Values are shown as they are, without the curve of a display: hence so much light.
fx.sun    = sun { azimuth = 239, elevation = 44, strength = 7 }
fx.sky    = sky { strength = 1.3 }

local scene  = geometry { mesh { "data/ground.obj" }, mesh { "data/crates.obj" } }
local solid  = shade { from = scene }
local volume = march {
  mode = "paper", sampling = "quasi_cubic", view = show:get() and "noise" or "beauty",
  density = density, radiance = colors, noise = detail,
  steps = steps, opacity = opacity, depth = scene.depth, resolution = 0.25,
}
local picture = over { volume = volume.color, source = solid }
local glow    = bloom { bright { picture, mode = "paper", threshold = 1.0 }, mode = "paper", alpha = 0.8 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 1, tonemap = "display" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
