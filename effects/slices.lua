-- Smoke from two planes: 2D flow is simulated in a few slices that stand round an axis, and what
-- they hold is turned round it. It costs a hundredth of air in three dimensions.
--
--   roil render effects/slices.lua --frames 96 -o plume.png
--   roil render effects/slices.lua --frames 96 --set wobble=0 -o turned.png
--   roil render effects/slices.lua --frames 96 --set slices.vorticity=0 -o calm.png

local fx = effect { name = "slices", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

local thickness = param { "thickness", 9, min = 0, max = 100, unit = "1/m", help = "how dense the smoke is" }
local heat      = param { "heat", 1, min = 0, max = 4, help = "temperature of the fire below" }
local wobble    = param { "wobble", 0.14, min = 0, max = 1, unit = "m", help = "how far the smoke is bent out of its round shape" }

-- What is turned round an axis looks turned. A small fractal offset hides it: a point is moved by it
-- before it is looked up in the slices. It rises as fast as the smoke does.
local offset = curl { frequency = 1.2, octaves = 3, drift = {0, 0, -1.6}, seed = 5 } * wobble

-- Two whole planes: each is met again half a turn on. Small enough for a computer without a graphics
-- card; on one that has it, try count = 4 and {256, 512} cells.
local flow = slices {
    count = 2, size = {64, 128}, height = 4, sides = "open", offset = offset, seed = 3,
    buoyancy_heat = 6, cooling_rate = 0.35, dissolve_rate = 0.1, vorticity = 4, variation = 0.4,
}

-- Places in a slice are shares of its width: the axis stands at x = 1/2.
flow:inflow { shape = disc { 0.5, 0.12, radius = 0.09 }, density = 1, temperature = heat, velocity = {0, 0.6} }

-- The offset is noise, which costs more than the slices do. Baked, it is evaluated once for each of
-- these voxels rather than at every step of every ray; on a fast card leave the bake out.
local smoke = bake(flow.density, { size = {64, 64, 128} })

fx.camera = orbit { target = {0, 0, 1.9}, distance = 8.5, yaw = 25, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 160, elevation = 48, color = {1, 0.95, 0.88}, strength = 5 }
fx.sky    = sky { zenith = {0.10, 0.20, 0.42}, horizon = {0.42, 0.50, 0.60}, strength = 0.7 }

local lit    = lighting { density = smoke * thickness, albedo = {0.96, 0.96, 0.97}, anisotropy = 0.2 }
local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit} }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
