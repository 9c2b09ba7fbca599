-- Firs in the light of a lamp, for scripts/bench/toon.lua: what is done to the picture is
-- what is measured. It does not move.
local fx = effect { name = "drawn", fps = 24, frames = 100 }

local add       = param { "add", "nothing", words = {"nothing", "outline", "outline published", "outline depth", "bands", "bloom mips", "bloom gaussian"} }:get()
local thickness = param { "thickness", 2.5, min = 0, max = 64 }
local passes    = param { "passes", 5, min = 1, max = 64, integer = true }
local part      = param { "part", 1, min = 0.125, max = 1, help = "of the picture's size: of the bloom" }:get()
local model     = param { "model", "physical", words = {"physical", "lambert", "blinn_phong", "toon"} }

fx.camera = camera { eye = {0, -9, 2.2}, target = {0, 0, 1.2}, fov = 40 }
fx.sun    = sun { azimuth = 250, elevation = 40, strength = 1 }
fx.lights = { point_light { position = {0, -2, 3}, power = 300 } }

local firs  = instances { mesh { "fir.obj" }, at = scatter { count = 24, size = {9, 6}, distance = 1, seed = 2 }, scale = {0.3, 0.7}, yaw = {0, 360} }
local scene = geometry { firs }
local solid = shade { from = scene, model = model, shadow_samples = 0 }
local picture, halo = solid, nil
if add == "outline" then
  picture = over { outline { from = scene, thickness = thickness }, solid }
elseif add == "outline published" then
  picture = over { outline { from = scene, thickness = thickness, mode = "published", normal_threshold = 0 }, solid }
elseif add == "outline depth" then
  picture = over { outline { depth = scene.depth, thickness = thickness }, solid }
elseif add == "bands" then
  picture = over { bands { solid, levels = 4 }, solid }
elseif add == "bloom mips" then
  halo = bloom { bright { solid, threshold = 0.1 }, resolution = part }
elseif add == "bloom gaussian" then
  halo = bloom { bright { solid, threshold = 0.1, mode = "paper" }, mode = "gaussian", passes = passes, resolution = part }
end
fx.output = final { source = picture, bloom = halo }
return fx
