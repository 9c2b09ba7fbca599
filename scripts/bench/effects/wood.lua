-- Firs of 504 triangles each, for scripts/bench/instances.lua: the same picture but for their number, which
-- fills a wood as deep as it must be.
local fx = effect { name = "wood", frames = 600 }

local count = param { "count", 1000, min = 1, max = 100000, integer = true }
local mode  = param { "mode", "auto", words = {"auto", "rays", "raster"} }
local lod   = param { "lod", 1, min = 0, max = 64, help = "pixels that simplified meshes may be off" }
local moves = param { "moves", 0, min = 0, max = 1, help = "part of the firs that change in each frame" }
local n     = count:get()

fx.camera = camera { eye = {0, -0.55 * 2.4 * math.sqrt(n) - 6, 7}, target = {0, 0, 1}, fov = 45, far = 2000 }
fx.sun    = sun { azimuth = 215, elevation = 32, color = {1, 0.93, 0.82}, strength = 5 }
fx.sky    = sky { zenith = "#4478b0", horizon = "#b9c9d6", strength = 0.6 }

-- On a grid, shaken, so that a hundred thousand are placed at once.
local places, side = {}, math.ceil(math.sqrt(n))
for i = 0, n - 1 do
  local x, y = i % side, i // side
  places[i + 1] = {2.4 * (x - side / 2) + math.sin(i * 12.9) , 2.4 * (y - side / 2) + math.sin(i * 78.2), 0}
end
local wood = instances {
  mesh { "fir.obj" }, at = places, scale = {0.6, 1.4}, yaw = {0, 360}, color = { {0.8, 0.9, 0.7}, {1, 1, 1} }, seed = 5,
}
fx.update = function(t)
  for i = 1, moves:get() * n do wood:set(i, { yaw = (37 * i + 90 * t) % 360 }) end
end

local scene = geometry { wood, mode = mode, lod = lod }
fx.output = final { shade { from = scene, shadow_samples = 0 } }
return fx
