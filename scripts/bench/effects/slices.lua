-- Flow in slices of which everything that costs time can be turned, for the sweeps slices.lua and
-- slices_look.lua: the solver alone, templates in it, and the same as a volume or as particles. One step
-- a frame, so that times of a frame are times of a step.
local width     = param { "width", 128, min = 16, max = 2048, integer = true, help = "cells of a slice, across" }
local height    = param { "height", 128, min = 16, max = 2048, integer = true, help = "cells of a slice, upwards" }
local count     = param { "count", 1, min = 1, max = 8, integer = true, help = "slices" }
local templates = param { "templates", 0, min = 0, max = 1000, integer = true, help = "of pressure, in each slice" }
local shown     = param { "shown", "nothing", words = {"nothing", "stack", "march", "baked", "particles"}, help = "what is drawn of it" }
local planes    = param { "planes", 128, min = 16, max = 512, integer = true, help = "of the stack, steps of the march" }
local points    = param { "points", 16384, min = 1024, max = 16777216, integer = true, help = "particles" }
local pixels    = param { "pixels", 0, min = 0, max = 64, help = "diameter of a particle in a picture of 512 rows, all of them together as bright as a million of one pixel; 0: 2 cm" }
local large     = param { "large", false, help = "shows what is larger than about two cells of 128: all else is blurred away" }
local best      = param { "best", false, help = "what others are compared with: 512 x 512 cells, or 4 million particles of a pixel" }

local across, up, n, wide = width:get(), height:get(), points:get(), pixels:get()
if best:get() and shown:get() == "particles" then n, wide = 4194304, 1 end
if best:get() and shown:get() ~= "particles" then across, up = 512, 512 end

local fx = effect { name = "slices", fps = 60, frames = 600 }
local tall = up / across
local flow = slices {
  count = count:get(), size = {across, up}, height = 4 * tall, position = {0, 0, -2 * tall}, sides = "open", bottom = "open",
  buoyancy_heat = 3, cooling_rate = 0.5, dissolve_rate = 0.3, vorticity = 2, seed = 1,
}
flow:inflow { shape = disc { 0.5, 0.3 * tall, radius = 0.12 * math.min(1, tall), falloff = 0.02 }, density = 1, temperature = 1 }
if templates:get() > 0 then
  flow:templates {
    image "source.png", count = templates:get(), size = {0.05, 0.15}, lifetime = {0.05, 0.4}, strength = 2, scale_by = "density",
    region = disc { 0.5, 0.45 * tall, radius = 0.4 * math.min(1, tall) },
  }
end

fx.camera = camera { eye = {0, -7, 0.6}, target = {0, 0, 0}, fov = 36 }
local glow = palette { {0, "#000000"}, {0.4, "#a02000"}, {1, "#ffe0a0"} }
local density, radiance = flow.density * 4, glow(flow.temperature).rgb
local pictures = {
  nothing = function() return march { density = density, steps = 1, skipping = "off" } end, -- next to it
  stack   = function() return stack { density = density, radiance = radiance, slices = planes } end,
  march   = function() return march { density = density, radiance = radiance, steps = planes } end,
  baked   = function()
    local size = { size = planes:get(), box = flow.box }
    return march { density = bake(density, size), radiance = glow(bake(flow.temperature, size)).rgb, steps = planes }
  end,
  particles = function()
    local smoke = particles {
      count = n, rate = n, burst = wide > 0 and n or 0, lifetime = {0.9, 1}, velocity = flow.velocity,
      shape = sphere { position = {0, 0, -0.8}, radius = 0.5 },
    }
    if wide == 0 then return splats { particles = smoke, size = 0.02, color = {1, 0.8, 0.6}, opacity = 0.1 } end
    local metres = 2 * 7 * math.tan(math.rad(18)) / 512 -- of a pixel, in the middle
    return splats { particles = smoke, size = wide * metres, color = {1, 0.8, 0.6}, opacity = 0.02, brightness = 1048576 / (n * wide * wide) }
  end,
}
local picture = pictures[shown:get()]()
if large:get() then picture = bloom { picture, mode = "gaussian", passes = 3, resolution = 0.5 } end
fx.output = final { picture, tonemap = "reinhard" }.color
return fx
