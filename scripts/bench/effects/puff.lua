-- A ball of smoke of which everything that costs time can be turned, for the sweeps beside this folder.
local fx = effect { name = "puff", fps = 24, frames = 100 }
local noise   = param { "noise", "perlin", words = {"none", "value", "perlin", "perlin_4d", "simplex", "worley", "worley_paper", "worley_f2_f1",
                                                     "curl", "worley_curl", "worley_tiled"}, help = "what the smoke is made of" }
local octaves = param { "octaves", 3, min = 1, max = 8, integer = true, help = "of the noise" }
local steps   = param { "steps", 64, min = 2, max = 4096, integer = true, help = "samples along each ray" }
local voxels  = param { "voxels", 0, min = 0, max = 512, integer = true, help = "along each side of a grid of the smoke; 0: none, and the noise is marched" }
local lights  = param { "lights", 0, min = 0, max = 8, integer = true, help = "points of light around the smoke" }
local lit     = param { "lit", false, help = "by the pass lighting, with shadows of all lights" }

local count = octaves:get()
local function shape(more)
  local all = { frequency = 1.5, octaves = count, drift = {0, 0, -0.5} }
  for key, value in pairs(more or {}) do all[key] = value end
  return all
end
local ball  = sphere { position = {0, 0, 0}, radius = 1.2, falloff = 0.8 }
local kinds = {
  none         = function() return ball end,
  value        = function() return ball * value(shape()) end,
  perlin       = function() return ball * perlin(shape()) end,
  perlin_4d    = function() return ball * perlin(shape { speed = 1 }) end,
  simplex      = function() return ball * simplex(shape()) end,
  worley       = function() return ball * worley(shape()) end,
  worley_paper = function() return ball * worley(shape { mode = "paper" }) end,
  worley_f2_f1 = function() return ball * worley(shape { distance = "f2_f1" }) end,
  curl         = function() return ball:warp(curl(shape()), 0.3) end,
  worley_curl  = function() return ball * worley(shape()):warp(curl(shape()), 0.25) end,
  worley_tiled = function() return ball * worley(shape()):tile { resolution = 64 } end,
}
local smoke = kinds[noise:get()]()
if voxels:get() > 0 then
  smoke = bake(smoke, { size = voxels:get(), box = { min = {-1.3, -1.3, -1.3}, max = {1.3, 1.3, 1.3} } })
end

fx.camera = camera { eye = {0, -5, 0.6}, target = {0, 0, 0}, fov = 38 }
fx.sun    = sun { azimuth = 215, elevation = 38, strength = 3 }
local around = {}
for i = 1, lights:get() do
  local angle = 2.4 * i
  around[i] = point_light { position = {2.2 * math.cos(angle), 2.2 * math.sin(angle), 0.4 * i - 1.5}, color = {1, 0.7, 0.4}, power = 60 }
end
fx.lights = around

local density = smoke * 8
local medium  = lit:get() and lighting { density = density, albedo = {0.8, 0.8, 0.8} }
local volume  = medium and march { from = medium, steps = steps } or march { density = density, albedo = {0.8, 0.8, 0.8}, steps = steps }
fx.output = final { volume.color, tonemap = "reinhard" }.color
return fx
