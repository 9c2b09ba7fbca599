-- The same plume five times, left alone and stirred: templates are small pictures of pressure or
-- velocity that are put into a flow for a moment, again and again, each time elsewhere. The flow
-- does the rest. Here is a single slice, seen as it is; `slices` turns it round an axis for any effect.
--
--   roil render effects/templates.lua --frames 48 --set stir=tongues -o tongues.png
--   roil live effects/templates.lua

local fx = effect { name = "templates", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local stir     = param { "stir", "puffs", words = {"nothing", "puffs", "tongues", "eddies", "wrinkles"}, help = "which templates are put into the flow" }:get()
local strength = param { "strength", 1, min = 0, max = 10, help = "factor of theirs" }

local flow = slices {
    count = 1, size = {96, 192}, height = 4, seed = 3,
    buoyancy_heat = 6, cooling_rate = 0.35, dissolve_rate = 0.15, vorticity = 2, variation = 0.1,
}
flow:inflow { shape = disc { 0.5, 0.12, radius = 0.09 }, density = 1, temperature = 1, velocity = {0, 0.6} }

-- All of them are put where there is smoke (`within`), 40 at a time. Sizes are in widths of the
-- slice, lifetimes in seconds: small and short make fine detail, large and long make billows.
if stir == "puffs" then
    -- Raised pressure is a source, the only thing that makes room in a flow that cannot expand. It
    -- fades with the smoke.
    flow:templates {
        image "templates/source.exr", kind = "pressure", strength = 2 * strength, scale_by = "density",
        count = 40, size = {0.08, 0.25}, lifetime = {0.1, 0.5}, within = "density", above = 0.05,
    }
elseif stir == "tongues" then
    -- High pressure at the root and low beside the tip, their upper edge turned out of the smoke: only
    -- near its surface, where the density is between these two.
    flow:templates {
        image "templates/corona.exr", kind = "pressure", strength = 4 * strength, align = "contour",
        count = 40, size = {0.08, 0.25}, lifetime = {0.1, 0.3}, within = "density", above = 0.05, below = 0.6,
    }
elseif stir == "eddies" then
    -- Velocity is a force. Vortices of both senses, where it is hot: below all goes straight up.
    for _, sense in ipairs { "left", "right" } do
        flow:templates {
            image("templates/vortex_" .. sense .. ".exr"), kind = "velocity", strength = 25 * strength, scale_by = "temperature",
            count = 20, size = {0.1, 0.35}, lifetime = {0.1, 0.4}, within = "density", above = 0.05,
            region = box { position = {0.5, 1.2, 0}, size = {1, 1.6, 1} },
        }
    end
elseif stir == "wrinkles" then
    flow:templates {
        image "templates/corrugation.exr", kind = "pressure", strength = 6 * strength, align = "contour",
        count = 40, size = {0.08, 0.25}, lifetime = {0.1, 0.5}, within = "density", above = 0.05,
    }
end

-- A picture of the slice: light that is given off, and nothing that hides it.
local slice = flow:slice(1)
local sheet = box { position = {0, 0, 2}, size = {2, 0.1, 4} }
local smoke = palette { {0, "#000000"}, {0.25, "#16202c"}, {1, "#8a97a8"} }
local fire  = palette { {0, "#000000"}, {0.3, "#701c08"}, {0.7, "#d88a30"}, {1, "#fff0c8"} }

fx.camera = orbit { target = {0, 0, 2}, distance = 20, yaw = 0, pitch = 0, fov = 12 }
fx.sun    = sun { strength = 0 }
fx.sky    = sky { strength = 0 }

local volume = march { density = 1e-4 * sheet, emission = (smoke(slice.density) * 0.6 + fire(slice.temperature)) * sheet * 10, steps = 32 }
local shown  = final { volume, tonemap = "none" }

fx.output = shown.color
fx.linear = shown.linear
return fx
