-- What surfaces are made of: `material` says how much a mesh mirrors, how rough it is, whether it is a
-- metal and what it gives off; the option `model` of `shade` says what is made of that.
--
--   roil render effects/materials.lua -o materials.png
--   roil render effects/materials.lua -o toon.png --set model=toon --set shade.toon_levels=3
--   roil render effects/materials.lua -o published.png --set model=blinn_phong
--
-- Front row: lacquer, from polished to chalky. Middle: metals, likewise. Behind: lamps, whose material
-- glows. The last ball of each row has `toon = false`: its light stays smooth in any model.

local fx = effect { name = "materials", fps = 24, frames = 96 }

local model  = param { "model", "physical", words = {"physical", "lambert", "blinn_phong", "toon"}, help = "what surfaces make of light" }:get()
local gloss  = param { "gloss", 0.5, min = 0, max = 1, help = "how much the lacquer mirrors" }
local glow   = param { "glow", 0.9, min = 0, max = 50, help = "radiance of the lamps" }

-- One mesh, many materials. A number of a material may be a parameter, a curve or a function of time.
local balls = {}
local function ball(x, y, radius, surface)
  balls[#balls + 1] = mesh { "data/sphere.obj", position = {x, y, radius}, scale = radius, material = material(surface) }
end

local lacquer = {"#a3161c", "#b8431a", "#c08a1e", "#3e7a3a", "#1f5f8a", "#5a3a8a"}
local metal   = { {0.95, 0.64, 0.54}, {1.00, 0.78, 0.34}, {0.91, 0.80, 0.55}, {0.96, 0.96, 0.97}, {0.66, 0.66, 0.70}, {0.56, 0.57, 0.58} } -- copper, gold, brass, silver, chromium, iron
for i = 1, 6 do
  local x, rough = 1.3 * (i - 3.5), (i - 1) / 5
  ball(x, -1.45, 0.5, { color = lacquer[i], specular = gloss, roughness = 0.08 + 0.92 * rough, toon = i < 6 })
  ball(x, 0.1, 0.5, { color = metal[i], metallic = 1, roughness = 0.05 + 0.75 * rough, toon = i < 6 })
end
local lamp = { {1.0, 0.28, 0.05}, {1.0, 0.62, 0.20}, {0.18, 0.42, 1.0} }
for i = 1, 3 do
  ball(2.6 * (i - 2), 1.9, 0.62, { color = {0.02, 0.02, 0.02}, emission = vec(lamp[i][1] * glow, lamp[i][2] * glow, lamp[i][3] * glow), roughness = 0.4 })
end

local floor = mesh { "data/ground.obj", material = material { color = {0.085, 0.085, 0.095}, specular = 0.5, roughness = 0.35 } }

fx.camera = orbit { target = {0, 0.15, 0.35}, distance = 11, pitch = 27, yaw = curve { {0, -9}, {4, 9}, shape = "ease_in_out" }, fov = 30 }
fx.sun    = sun { azimuth = 235, elevation = 38, color = {1, 0.93, 0.82}, strength = 2.2, angle = 2 }
fx.sky    = sky { zenith = {0.16, 0.26, 0.46}, horizon = {0.50, 0.44, 0.42}, strength = 0.6 }
fx.lights = { -- what the lamps send to the rest
  sphere_light { position = {-2.6, 1.9, 0.62}, radius = 0.64, color = lamp[1], power = 20 * glow },
  sphere_light { position = {0, 1.9, 0.62}, radius = 0.64, color = lamp[2], power = 20 * glow },
  sphere_light { position = {2.6, 1.9, 0.62}, radius = 0.64, color = lamp[3], power = 20 * glow },
}

balls.name = "scene"
table.insert(balls, floor)
local scene = geometry(balls)
local solid = shade { from = scene, model = model, shadow_samples = 8, sky_samples = 4, haze = 0.012 }
local halo  = bloom { bright { solid, threshold = 1.2 }, radius = 0.8 }
local shown = final { source = solid, bloom = halo, bloom_intensity = 0.35, tonemap = "aces", exposure_ev = 0.4 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
