-- What surfaces are made of: `material` says how much a mesh mirrors, how rough it is, whether it is a
-- metal and what it gives off; the option `model` of `shade` says what is made of that.
--
--   roil render effects/materials.lua --frames 48 -o materials.png
--   roil render effects/materials.lua --frames 48 -o toon.png --set model=toon --set shade.toon_levels=3
--   roil render effects/materials.lua --frames 48 -o published.png --set model=blinn_phong
--
-- One dragon, eight times, around three pearls that glow. To the left it is of lacquer, to the right of
-- metal: gold, copper, silver, iron. Those in front are polished, those behind ever rougher, which is how
-- a highlight and what the sky sends back become wide and dull. The last of each side has `toon = false`:
-- its light stays smooth in any model.

local fx = effect { name = "materials", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local model = param { "model", "physical", words = {"physical", "lambert", "blinn_phong", "toon"}, help = "what surfaces make of light" }:get()
local gloss = param { "gloss", 0.5, min = 0, max = 1, help = "how much the lacquer mirrors" }
local glow  = param { "glow", 0.8, min = 0, max = 50, help = "radiance of the pearls" }
local yawn  = param { "yawn", 16, min = 0, max = 35, unit = "degrees", help = "how far jaws are open" }

-- One mesh, many materials. A number of a material may be a parameter, a curve or a function of time.
local court = { name = "scene" }
local function dragon(angle, surface)
  local made, around = material(surface), math.rad(angle)
  local place = node { position = {4.1 * math.cos(around), 4.2 * math.sin(around), 0}, rotation = {0, 0, angle + 180} }
  table.insert(court, mesh { "data/creature.obj", parent = place, material = made })
  table.insert(court, mesh { "data/creature_jaw.obj", parent = place, position = {-0.115, 0, 1.656}, rotation = vec(0, yawn, 0), material = made })
end

local lacquer = {"#a3161c", "#c0501a", "#3e7a3a", "#1f4f8a"}
local metal   = { {1.00, 0.78, 0.34}, {0.95, 0.60, 0.48}, {0.96, 0.96, 0.97}, {0.56, 0.57, 0.58} }
for i, angle in ipairs { 201, 164, 134, 108 } do
  local rough, smooth_in_toon = (i - 1) / 3, i == 4
  dragon(angle, { color = lacquer[i], specular = gloss, roughness = 0.1 + 0.8 * rough, toon = not smooth_in_toon })
  dragon(180 - angle, { color = metal[i], metallic = 1, roughness = 0.2 + 0.45 * rough, toon = not smooth_in_toon })
end

-- What glows lights nothing by itself: a light of the same place, size and colour does.
local lights = {}
for _, pearl in ipairs {
  { color = {1, 0.14, 0.02}, position = {-1.05, 0.1, 0.7}, radius = 0.3 },
  { color = {1, 0.46, 0.10}, position = {0, -0.5, 1.2}, radius = 0.46 },
  { color = {0.05, 0.22, 1}, position = {1.05, 0.1, 0.7}, radius = 0.3 },
} do
  local r, g, b = table.unpack(pearl.color)
  local shine = material { color = {0.02, 0.02, 0.02}, emission = vec(r * glow, g * glow, b * glow), roughness = 0.25 }
  table.insert(court, mesh { "data/sphere.obj", position = pearl.position, scale = pearl.radius, material = shine })
  table.insert(lights, sphere_light { position = pearl.position, radius = 1.03 * pearl.radius, color = pearl.color, power = 900 * pearl.radius * glow })
end
table.insert(court, mesh { "data/ground.obj", material = material { color = {0.055, 0.055, 0.065}, specular = 0.5, roughness = 0.45 } })

fx.camera = orbit { target = {0, 0, 1.2}, distance = 15, pitch = 6.5, yaw = curve { {0, -9}, {4, 9}, shape = "ease_in_out" }, fov = 26 }
fx.sun    = sun { azimuth = 250, elevation = 34, color = {1, 0.80, 0.58}, strength = 2.4, angle = 2 }
fx.sky    = sky { zenith = {0.03, 0.10, 0.36}, horizon = {0.46, 0.24, 0.14}, strength = 0.9 }
fx.lights = lights

local scene = geometry(court)
local solid = shade { from = scene, model = model, shadow_samples = 8, sky_samples = 4, haze = 0.004 }
local halo  = bloom { bright { solid, threshold = 1.2 }, radius = 0.8 }
local shown = final { source = solid, bloom = halo, bloom_intensity = 0.35, tonemap = "aces", exposure_ev = 0.3 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
