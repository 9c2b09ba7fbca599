-- Two hundred lights circle through a ruin by night. Stone that is wet mirrors them, mist shows their way.
--
--   roil render effects/deferred_lights.lua --frames 90 -o lights.png
--   roil live effects/deferred_lights.lua
--
-- What each pixel shows is found once (`geometry`) and lit afterwards (`shade`): a light then costs what
-- it lights, whatever the scene is made of. `point_lights` says how they move and shine, by fields that
-- the device evaluates for each of them: light_index and light_random tell them apart. point_lights_by chooses
-- how a pixel finds those that reach it: by lists for tiles of the picture, by spheres that are drawn
-- around the lights as published, or by asking all of them; path = "forward" lights triangles where they
-- are drawn instead. The picture is the same.

local fx = effect { name = "deferred_lights", fps = 30, frames = 600, author = "the roil authors", licence = "MIT" }

local lights = param { "lights", 200, min = 1, max = 16384, integer = true, help = "how many" }
local speed  = param { "speed", 0.16, min = 0, max = 2, unit = "rad/s", help = "of the lights around the middle, in the mean" }
local reach  = param { "reach", 2.9, min = 0.5, max = 20, unit = "m", help = "how far each of them lights" }
local power  = param { "power", 7, min = 0, max = 200, unit = "W", help = "of each" }
local mist   = param { "mist", 0.012, min = 0, max = 0.2, unit = "1/m", help = "how much the air scatters" }
local turn   = param { "turn", 1.2, min = 0, max = 30, unit = "degrees/s", help = "of the camera around the ruin" }
local way    = param { "point_lights_by", "auto", words = {"auto", "all", "tiles", "volumes"}, help = "how a pixel finds the lights that reach it" }
local path   = param { "path", "deferred", words = {"deferred", "forward"}, help = "whether light comes after all is drawn, or with it" }
local model  = param { "model", "physical", words = {"physical", "lambert", "blinn_phong", "toon"}, help = "what stone makes of light" }

fx.camera = orbit { target = {0, 0, 1.95}, distance = 13.8, yaw = 14 + turn * time, pitch = 6.5, fov = 42, near = 0.1, far = 300 }
fx.sun    = sun { azimuth = 165, elevation = 30, color = {0.45, 0.62, 1}, strength = 0.035 } -- a moon behind the ruin
fx.sky    = sky { night = 1, night_zenith = {0.0005, 0.0010, 0.0024}, night_horizon = {0.0022, 0.0036, 0.0068}, stars = 0.25 }

-- Circles around the middle: each begins at its own angle, so that they are spread evenly, and has a
-- radius, height and speed by chance. They bob twice a round.
local function chance(step) return fract(light_random * step) end
local around = light_index * (2 * math.pi / lights:get()) + time * speed * lerp(0.4, 1.6, chance(57))
local radius = lerp(1.9, 8.4, light_random)
local height = lerp(0.22, 4.3, chance(23) ^ 1.6) + 0.18 * sin(2 * around)
local size   = chance(13) ^ 6 -- most are sparks, a few are lanterns
local tone   = palette { -- embers, a few of them lost souls
  {0.00, {1.00, 0.36, 0.07}}, {0.40, {1.00, 0.56, 0.18}}, {0.66, {1.00, 0.24, 0.08}},
  {0.72, {0.08, 0.50, 1.00}}, {0.90, {0.10, 0.85, 0.80}}, {1.00, {0.55, 0.35, 1.00}},
}

local lamps = point_lights {
  count = lights:get(),
  position = vec(radius * sin(around + math.pi / 2), radius * sin(around), height),
  color = tone(chance(91)).rgb,
  power = power * lerp(0.03, 6, size),
  range = reach, radius = lerp(0.008, 0.05, size),
}

local bronze = material { color = {0.17, 0.22, 0.17}, specular = 0.9, roughness = 0.34 } -- old, and green
local woods  = instances {
  mesh { "data/pine.obj" },
  at = scatter { count = 90, size = {90, 90}, distance = 3, seed = 4, inside = length(vec(position.x, position.y, 0)) - 21 },
  scale = {0.8, 1.9}, yaw = {0, 360}, color = {0.5, 0.6, 0.6}, seed = 2,
}
local ruin   = mesh { "data/rotunda.obj" }
local paving = mesh { "data/rotunda_floor.obj" }
local dragon = mesh { "data/creature.obj", scale = 1.5, position = {-0.2, 0, 0.35}, rotation = {0, 0, -15}, material = bronze }

local scene, lit
if path:get() == "deferred" then
  scene = geometry { ruin, paving, dragon, woods }
  lit   = shade { from = {scene, lamps}, point_lights_by = way, model = model }
else
  scene = forward { ruin, paving, dragon, woods, from = lamps, point_lights_by = way:get() == "all" and "all" or "tiles", model = model }
  lit   = scene.color
end
local seen    = point_light_glows { from = {scene, lamps}, mist = mist }
local picture = over { seen, lit, from = scene }
local glow    = bloom { bright { picture, threshold = 1.2 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.10, exposure_ev = 2.6, tonemap = "agx", saturation = 1.25 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
