-- An explosion from four planes: heat is let go all at once, pressed apart by large templates, and
-- rolls up into a mushroom with fire inside its dark smoke. Nothing is read from a file: 2D flow is
-- simulated in the planes and turned round the axis (Krueger and Westermann 2005, section 4.2).
--
--   roil render effects/slice_explosion.lua --frames 40 -o explosion.png
--   roil render effects/slice_explosion.lua --frames 40 --set rendering=particles -o points.png
--   roil render effects/slice_explosion.lua --frames 40 --set detail=1 -o fine.png   -- four times the work
--
-- Play with `blast` (0 leaves buoyancy alone: a puff of hot air), `heat` and `wobble`.

local fx = effect { name = "slice_explosion", fps = 24, frames = 84, author = "the roil authors", licence = "MIT" }

local detail     = param { "detail", 0.5, min = 0.25, max = 4, help = "cells along each edge of a slice, relative to 144 x 160; taken when the effect loads" }
local rendering  = param { "rendering", "volume", words = {"volume", "particles", "both"}, help = "how the flow is shown" }:get()
local thickness  = param { "thickness", 9, min = 0, max = 50, unit = "1/m", help = "how dense the smoke is" }
local heat       = param { "heat", 1, min = 0, max = 3, help = "of what is let go: how fast it rises, how long it glows" }
local blast      = param { "blast", 1, min = 0, max = 5, help = "strength of the templates, which press it apart" }
local brightness = param { "brightness", 3, min = 0, max = 50, help = "factor of the fire's light" }
local eaten      = param { "eaten", 1, min = 0, max = 3, help = "how much noise eats from the smoke's edges" }
local wobble     = param { "wobble", 0.45, min = 0, max = 2, unit = "m", help = "how far the volume is bent out of its round shape" }

-- What is turned round an axis looks turned. Points are moved by a fractal offset before they are
-- looked up in the slices, which rises with the smoke.
local offset = curl { frequency = 0.45, octaves = 3, persistence = 0.55, drift = {0, 0, -1.5}, seed = 5 } * wobble

local function cells(count) return math.max(16, 8 * math.floor(count * detail:get() / 8 + 0.5)) end
local flow = slices {
  count = 4, size = {cells(144), cells(160)}, height = 10, sides = "open", offset = offset, seed = 3,
  buoyancy_heat = 4.2, cooling_rate = 0.8, dissolve_rate = 0.05, vorticity = 4, variation = 0.3,
}

-- A vast amount of heat near the centre, and less and less after that; smoke goes on coming.
flow:inflow {
  shape = disc { 0.5, 0.1, radius = curve { {0, 0.09}, {0.3, 0.07}, {1.5, 0.04} }, falloff = 0.03 },
  density = curve { {0, 1}, {1.5, 0.8}, {4, 0.5} }, temperature = heat * curve { {0, 3}, {0.25, 2}, {0.8, 0.9}, {2, 0.3} },
}

-- Large templates of raised pressure push from its heart. They are as strong as the smoke is dense
-- where they are, so that they fade outwards and do nothing outside of it.
flow:templates {
  image "templates/source.exr", kind = "pressure", strength = blast * curve { {0, 110}, {0.25, 50}, {0.8, 8}, {2.5, 2} },
  scale_by = "density", within = "density", above = 0.15, count = 24, size = {0.12, 0.4}, lifetime = {0.05, 0.25}, blend = 0.03,
}

-- One sample for all that is shown: the offset is evaluated once for each of these voxels.
local box    = {cells(144), cells(144), cells(160)}
local turned = bake(vec(flow.density, flow.temperature, 0), { size = box })

-- Noise that the flow carries along is what is finer than its cells.
local lumps = worley { frequency = 0.9, octaves = 4, persistence = 0.6, lacunarity = 2.1, seed = 11 }
              :tile { resolution = 128, octaves = 2 }:advect(bake(flow.velocity, { size = {32, 32, 40} }), { period = 0.8, mean = 0.48 })
local cover = clamp(turned.x * 1.6, 0, 1)
local smoke = cover * smoothstep(0, 0.2, cover - eaten * (1 - lumps) * (1 - 0.7 * cover))
local fire  = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local hot   = turned.y * (0.1 + 1.6 * smoothstep(0.33, 0.9, lumps)) -- lumps of fire, and dark soot between them
local flash = curve { {0, 4}, {0.2, 3}, {0.7, 1.2}, {1, 1} } -- fierce at first
local glow  = fire(mix(1100, 2500, clamp(hot * 0.6, 0, 1))) * smoothstep(0.1, 0.8, hot) * brightness * flash

fx.camera = camera { eye = {0, -22, 2}, target = {0, 0, 4.6}, fov = 30, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239, elevation = 34, color = {1, 0.93, 0.82}, strength = 4.6 }
fx.sky    = sky { zenith = {0.10, 0.24, 0.58}, horizon = {0.50, 0.60, 0.72}, strength = 0.6 }

local lit = lighting {
  density = smoke * thickness, emission = glow * smoke,
  albedo = {0.42, 0.40, 0.38}, anisotropy = 0.2, sampling = "linear",
}
local scene  = geometry { mesh { "data/ground.obj" }, mesh { "data/crates.obj", position = {-3.2, -7, 0} } }
local solid  = shade { from = {scene, lit}, haze = 0.002 }

local picture = solid
if rendering ~= "particles" then
  local volume = march { from = {lit, scene}, steps = 128, jitter = 0.5, resolution = 0.5 }
  picture = over { volume, picture, from = {volume, scene} }
end
if rendering ~= "volume" then
  -- Small puffs that go where the flow goes, and are what the volume is where they are. What a plane carries is
  -- blown to rings once the plane is turned: they live shortly, and are born again wherever there is smoke,
  -- so that it stays filled however it rolls. No volume is drawn before them that would dim them.
  local puffs = particles {
    count = 32768, rate = 36000, lifetime = {0.4, 0.8}, seed = 8,
    shape = flow.density, threshold = 0.15, velocity = flow.velocity,
  }
  local there = smoke * over_age { {0, 0}, {0.25, 1}, {0.7, 1}, {1, 0} }
  local size  = curve { {0, 0.22}, {1, 0.26}, {3, 0.45} } * (0.6 + 0.8 * particle_random)
  local dark  = splats {
    name = "puffs", from = {puffs, scene, lit}, size = size, color = {0.75, 0.72, 0.68}, opacity = 0.7 * there,
    blend = "sorted", lit = "on", soften = 0.1, entries = 16, view_steps = 0,
  }
  local flames = splats { -- seen through some of the smoke, not all: puffs leave gaps
    name = "flames", from = {puffs, scene, lit}, size = size, color = glow.rgb * there,
    brightness = curve { {0, 0.03}, {0.8, 0.03}, {1.8, 0.06} }, extinction = {0.2, 0.2, 0.2},
  }
  picture = over { dark, picture, from = {dark, scene} }
  picture = over { flames, picture, from = {flames, scene} }
end

local halo  = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown = final { source = picture, bloom = halo, bloom_intensity = 0.35, exposure_ev = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
