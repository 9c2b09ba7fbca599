-- A plume in three dimensions, left alone and stirred: templates are small pictures of pressure or
-- velocity that are put into the gas for a moment, again and again, each time elsewhere. Turned about
-- their upright line, or extruded, they fill a ball or a piece of a tube. The gas does the rest.
--
--   roil render effects/templates_3d.lua --frames 48 --set stir=rings -o rings.png
--   roil live effects/templates_3d.lua

local fx = effect { name = "templates 3d", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local stir     = param { "stir", "puffs", words = {"nothing", "puffs", "tongues", "rings", "tubes"}, help = "which templates are put into the gas" }:get()
local strength = param { "strength", 1, min = 0, max = 10, help = "factor of theirs" }

-- Warm smoke out of a vent. Nothing burns here; in a fire the templates do the same. Of `lbm`, too:
-- air:templates has the same keys, and density, temperature and dye to go by.
local gas = pyro {
    size = {40, 40, 72}, voxel_size = 0.09, speed = 6, cooling = 0,
}
gas:source {
    shape = sphere { position = {0, 0, 0.35}, radius = 0.3 },
    soot = 0.004, temperature = 380, velocity = {0, 0, 1.5}, rate = 20,
}

-- Sizes are metres, lifetimes seconds: small and short make fine detail, large and long make billows.
if stir == "puffs" then
    -- Raised pressure is a source: 8 times as much as is there comes out of its middle in a second,
    -- and smoke with it where there is some.
    gas:templates {
        image "templates/source.exr", kind = "pressure", strength = 8 * strength,
        count = 24, size = {0.5, 1.2}, lifetime = {0.2, 0.6}, within = "soot", above = 5e-4,
    }
elseif stir == "tongues" then
    -- Blown out of the surface of the smoke, where there is neither much of it nor none.
    gas:templates {
        image "templates/jet.exr", kind = "velocity", strength = 30 * strength, align = "contour",
        count = 24, size = {0.6, 1.2}, lifetime = {0.2, 0.5}, within = "soot", above = 2e-4, below = 2e-3,
    }
elseif stir == "rings" then
    -- A pair of vortices, turned about the line between them, is a ring that carries itself on: here
    -- round the plume, by a field of directions.
    gas:templates {
        image "templates/pair.exr", kind = "velocity", strength = 25 * strength, align = "direction",
        direction = vec(-position.y, position.x, 0.3), spread = 20,
        count = 16, size = {0.7, 1.4}, lifetime = {0.2, 0.6}, within = "soot", above = 2e-4,
    }
elseif stir == "tubes" then
    -- Vortices of both senses, extruded, any way: eddies.
    for _, sense in ipairs { "left", "right" } do
        gas:templates {
            image("templates/vortex_" .. sense .. ".exr"), kind = "velocity", depth = "extrude",
            strength = 25 * strength, count = 14, size = {0.5, 1.4}, lifetime = {0.2, 0.6},
            within = "soot", above = 2e-4,
        }
    end
end

fx.camera = orbit { target = {0, 0, 2.3}, distance = 13, yaw = 25, pitch = 3, fov = 25 }
fx.sun    = sun { azimuth = 120, elevation = 40, color = {1, 0.92, 0.8}, strength = 7 }
fx.sky    = sky { zenith = {0.04, 0.11, 0.32}, horizon = {0.32, 0.42, 0.56}, strength = 0.8 }

local smoke  = clamp(gas.soot, 0, 0.004) * 2500 -- 1/m
local lit    = lighting { density = smoke, albedo = {0.9, 0.9, 0.92}, anisotropy = 0.2, sampling = "cubic" }
local scene  = geometry { mesh { "data/ground.obj", color = {0.7, 0.75, 0.6} } }
local solid  = shade { from = {scene, lit}, haze = 0.01 }
local volume = march { from = {lit, scene}, steps = 96 }

local shown = final { source = over { volume, solid, from = {volume, scene} }, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
return fx
