-- Shows @FILES@. roil wrote this file; it is yours to change.
local fx = effect { name = "@NAME@", fps = 24, frames = @FRAMES@ }

local volume = vdb { "@FILES@", fps = 24 }
local box    = volume.box
local width  = math.max(box.max[1] - box.min[1], box.max[2] - box.min[2], box.max[3] - box.min[3])
local middle = { (box.min[1] + box.max[1]) / 2, (box.min[2] + box.max[2]) / 2, (box.min[3] + box.max[3]) / 2 }

local density = param { "density", 40 / width, min = 0, max = 400 / width, unit = "1/m", help = "how thick it is" }

fx.camera = orbit { target = middle, distance = 2.2 * width, pitch = 10 }
fx.sun    = sun { azimuth = 215, elevation = 40, strength = 6 }
fx.sky    = sky { zenith = {0.1, 0.2, 0.4}, horizon = {0.4, 0.5, 0.6}, strength = 0.7 }

local lit   = lighting { density = volume["@GRID@"] * density, albedo = {0.9, 0.9, 0.9}, anisotropy = 0.2 }
local drawn = march { from = {lit}, steps = 128 }

fx.output = final { source = drawn, tonemap = "aces" }.color
return fx
