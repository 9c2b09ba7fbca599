-- A comic's explosion: the burst of explosion.lua in six colours. What is marched is smooth; `bands` cuts
-- it into flat shapes, once by how the smoke is lit and once by how hot it glows, and these are laid over
-- each other like cut paper. Lines round the smoke are those of `outline`, round a mask of it in the place
-- of the depth. Twelve pictures a second, as if each had been drawn.
--
--   roil render effects/comic_blast.lua --frames 14 -o blast.png
--   roil render effects/comic_blast.lua --frames 14 --set fires=6 --set greys=6 --set ink=0 -o soft.png
--
-- Play with `fires` and `greys`, how many colours there are, with `lumps`, and with the palettes.

local fx = effect { name = "comic_blast", fps = 12, frames = 44, author = "the roil authors", licence = "MIT" }

local fires = param { "fires", 4, min = 1, max = 12, integer = true, help = "colours of what glows" }
local greys = param { "greys", 3, min = 1, max = 12, integer = true, help = "colours of the smoke" }
local lumps = param { "lumps", 0.9, min = 0, max = 3, help = "how much the noise eats from the smoke's edges" }
local ink   = param { "ink", 3, min = 0, max = 20, help = "thickness of the lines, pixels of a picture of 1080 rows" }

-- ---- the burst: a grid of 32 cells each way, with round lumps of one size: details would be grain ---------

local burst = vdb { "data/explosion-32/*.vdb", fps = 24, blend = true }
local flow  = bake(curl { frequency = 0.6, octaves = 2, persistence = 0.5, speed = 0.4, seed = 3 }, { size = {48, 48, 48}, box = burst.box })
local torn  = bake(vec(burst.density, burst.temperature, burst.flame):warp(flow, 0.25), { size = {80, 80, 80}, box = burst.box })
local puffs = worley({ frequency = 1.1, octaves = 2, persistence = 0.5, drift = {0, 0, -0.5}, seed = 11 }):tile { resolution = 96, octaves = 2 }:warp(flow, 0.2)
local cover = clamp(torn.x * 2.4, 0, 1)
local fade  = curve { {0, 1}, {1.7, 1}, {3.4, 0.4}, shape = "ease_in_out" }
local crust = smoothstep(0, 0.25, cover - lumps * fade * (1 - puffs) * (1 - 0.6 * cover))
local body  = cover * crust
local hot   = torn.y * (0.05 + 1.5 * puffs * puffs) * smoothstep(0.02, 0.5, torn.z)

-- ---- where it stands --------------------------------------------------------------------------------------

fx.camera = camera { eye = curve { {0, {3.2, -11.2, 1.7}}, {3.6, {4.6, -11.6, 2.1}}, shape = "ease_in_out" }, target = {4, 4, 3.5}, fov = 34, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 246, elevation = 36, color = {1, 0.90, 0.72}, strength = 3.6, angle = 0.2 }
fx.sky    = sky { zenith = {0.0, 0.30, 0.56}, horizon = {0.80, 0.84, 0.66}, strength = 0.9 }
-- The flash lights the ground as long as something burns.
fx.lights = { point_light { name = "flash", position = {4, 3.2, 1.6}, color = {1, 0.45, 0.12}, power = curve { {0, 0}, {0.15, 2600}, {0.5, 1500}, {1.6, 250}, {2.1, 0} } } }

local rocks = instances {
  mesh { "data/rock.obj" }, mesh { "data/tuft.obj" },
  at = scatter { count = 150, size = {46, 40}, position = {4, 12, 0}, distance = 1.1, seed = 6, inside = length(vec(position.x - 4, position.y - 4, 0)) - 4.4 },
  kind = {0.5, 0.5}, scale = {0.35, 1.3}, yaw = {0, 360}, color = {1.5, 1.1, 0.8}, seed = 2,
}
local drums = instances {
  mesh { "data/barrel.obj" }, yaw = {0, 360}, seed = 7,
  at = { {0.4, 0.6, 0}, {1.1, 0.2, 0}, {0.75, 0.4, 0.89}, {7.9, 0.9, 0}, {8.6, 1.5, 0}, {9.2, 0.7, 0}, {-1.4, 1.6, 0} },
}
local scene = geometry { mesh { "data/ground.obj", color = {4.4, 3.3, 2.2} }, rocks, drums }
local lit   = lighting { density = body * 22, albedo = {0.8, 0.8, 0.8}, anisotropy = 0.1, sampling = "linear" }

-- ---- drawn ------------------------------------------------------------------------------------------------

local flat  = shade { from = {scene, lit}, model = "toon", toon_levels = 3 }
local grey  = march { name = "grey", from = {lit, scene}, steps = 96, jitter = 0 }
local light = march { name = "light", density = body * 3, radiance = vec(1, 1, 1) * hot, depth = scene.depth, steps = 96, jitter = 0 }

-- The smoke by how bright it is in the sun, the fire by its own light.
local ash   = palette { {0, {0.085, 0.050, 0.075}}, {0.5, {0.26, 0.17, 0.19}}, {1, {0.62, 0.46, 0.40}} }
local paint = palette { {0, {0.55, 0.045, 0.02}}, {0.34, {0.95, 0.20, 0.02}}, {0.67, {1, 0.55, 0.05}}, {1, {1, 0.92, 0.55}} }
local mask  = bands { name = "mask", grey, of = "opacity", levels = 1, low = 0.45, high = 1, color = {1, 0, 0} }
local cloud = bands { name = "cloud", grey, levels = greys, low = 0.13, high = 0.62, color = ash(position.y).rgb }
local cools = curve { {0, 0.12}, {1, 0.14}, {1.9, 0.42}, {2.9, 0.9} } -- what glows less is smoke
local fire  = bands { name = "fire", light, levels = fires, low = cools, high = 1.5, color = paint(position.y).rgb }
local lines = outline { from = scene, side = "outside", color = {0.030, 0.016, 0.030}, thickness = ink, normal_threshold = 60, reach = 40 }
local edge  = outline { name = "edge", depth = mask, mode = "published", depth_step = 0.5, color = {0.030, 0.016, 0.030}, thickness = 2 * ink }
local dark  = bands { name = "dark", grey, of = "opacity", levels = 1, low = 0.45, high = 1, color = {0.085, 0.050, 0.075} }
local picture = over { edge, over { fire, over { cloud, over { dark, over { lines, flat } } } } }

local halo  = bloom { bright { picture, mode = "paper", threshold = 0.85 }, mode = "gaussian", passes = 5, resolution = 0.25 }
local shown = final { source = picture, bloom = halo, bloom_mix = "luminance", bloom_intensity = 0.25, tonemap = "none" }

fx.output = shown.color
fx.depth  = scene.depth
return fx
