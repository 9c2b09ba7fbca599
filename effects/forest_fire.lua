-- A forest fire at dusk. Trees stand on a slope above a river; where one burns, it lights those within its
-- reach, faster with the wind than against it, and the river stops it. Every tree is one of `instances`,
-- whose state says when it caught fire and when it is burnt out: flames, smoke and light are fields of that
-- and of time, so that a tree costs the script something only when it changes.
--
--   roil live effects/forest_fire.lua          -- click into the forest, or press F over it; N is night, W turns the wind
--   roil render effects/forest_fire.lua --frames 430 -o fire.png
--   roil render effects/forest_fire.lua --frames 430 --event "0.5 click 30 10 0" -o other.png    -- lit over there instead
--   roil render effects/forest_fire.lua --frames 200 --set fires=500 --set burn=60 -o all.png    -- all of it at once
--   roil render effects/forest_fire.lua --frames 430 --set look=drawn -o drawn.png
--
-- Play with `wind`, `reach` (at 14 m the fire jumps the river) and `burn`.

local spread = require "spread"
local fx = effect { name = "forest_fire", fps = 24, frames = 720, seed = 3, author = "the roil authors", licence = "MIT" }

local trees = param { "trees", 500, min = 1, max = 4000, integer = true, help = "that there are" }:get()
local fires = param { "fires", 0, min = 0, max = 4000, integer = true, help = "that burn from the beginning" }
local reach = param { "reach", 8, min = 1, max = 30, unit = "m", help = "how far away a tree lights another" }:get()
local speed = param { "speed", 2, min = 0.1, max = 20, unit = "m/s", help = "of the fire along the ground, without wind" }:get()
local burn  = param { "burn", 9, min = 1, max = 1000, unit = "s", help = "that a tree burns, about" }:get()
local wind  = param { "wind", {3, 1.4, 0}, min = -15, max = 15, unit = "m/s", help = "drives the fire, the flames and the smoke" }
local night = param { "night", 0, min = 0, max = 1, help = "0: dusk, 1: night" }
local look  = param { "look", "natural", words = {"natural", "drawn"}, help = "drawn: light in bands, and lines around" }:get()
local soot  = param { "soot", 1, min = 0, max = 5, help = "how thick the smoke is" }
local blaze = param { "blaze", 1, min = 0, max = 5, help = "brightness of the flames" }

-- ---- where it burns: scripts/data/make_valley.py has made the ground by the same sums -------------------

local x, y    = position.x, position.y
local across  = y - (-20 + 9 * sin(x / 26 + 0.7) + 3 * sin(x / 11)) -- from the middle of the river
local swells  = 1.1 * sin(x / 13 + 1.3) * sin(y / 17 + math.pi / 2) + 0.5 * sin(x / 5.3 + y / 7.1)
local ground  = 24 * smoothstep(6, 100, across) + 2.5 * smoothstep(6, 40, -across) + swells * smoothstep(4, 15, abs(across))
                - 1.9 * exp(-(across / 5.2) ^ 2)
local glades  = smoothstep(0.30, 0.5, perlin { frequency = 0.045, octaves = 2, seed = 5 })

-- Kinds 1 and 2, and the same two burnt. State: when it caught fire, and when it is burnt out.
local forest = instances {
  mesh { "data/pine.obj" }, mesh { "data/leafy.obj" }, mesh { "data/pine_burnt.obj" }, mesh { "data/leafy_burnt.obj" },
  at = scatter { count = trees, size = {140, 110}, position = {6, 22, 0}, distance = 2.7, seed = 3, inside = abs(across) - 9.5,
                 density = glades * mix(0.2, 1, step(0, across)), height = ground - 0.1 },
  kind = {0.7, 0.3, 0, 0}, scale = {0.65, 1.3}, yaw = {0, 360}, lean = 4, state = {1e6, 1e6}, seed = 3,
}
local floor = instances {
  mesh { "data/tuft.obj" }, mesh { "data/fern.obj" }, mesh { "data/rock.obj" }, mesh { "data/stump.obj" },
  at = scatter { count = 1400, size = {120, 100}, position = {0, 10, 0}, distance = 0.8, seed = 8, inside = abs(across) - 5, height = ground - 0.03 },
  kind = {0.62, 0.26, 0.1, 0.02}, scale = {0.7, 1.7}, yaw = {0, 360}, lean = 6, seed = 4,
}
local water = mesh { "data/ground.obj", position = {0, 0, -0.9}, color = {0.25, 0.4, 0.6}, material = material { specular = 0.5, roughness = 0.25 } }

fx.camera = camera { eye = {-44, -47, 8.5}, target = {4, 2, 7.5}, fov = 38, near = 0.5, far = 900 }
fx.sun    = sun { azimuth = 205, elevation = 7, color = mix(vec(1, 0.46, 0.20), vec(0.5, 0.65, 1), night), strength = mix(1.9, 0.06, night) }
fx.sky    = sky { zenith = {0.045, 0.075, 0.19}, horizon = {0.56, 0.21, 0.10}, strength = 0.75, night = night }

-- ---- how it burns ---------------------------------------------------------------------------------------

local fire = spread { fx = fx, at = forest, reach = reach, speed = speed, wind = wind, burn = {0.8 * burn, 1.25 * burn}, late = 0.5, seed = 3 }
local singed, falling, glowing = {}, {}, {} -- trees that burn; scales of those that fall in; times at which others did

fx:on_start(function()
  singed, falling, glowing = {}, {}, {}
  for i = 1, math.min(fires:get(), #forest) do fire:ignite(i) end
end)
fire:on_ignite(function(i, t)
  singed[#singed + 1] = i
  forest:set(i, { state = {t, fire.ends[i]} })
  floor:set(floor:near(forest:get(i).position, 3.6), { color = {0.06, 0.05, 0.045} })
end)
fire:on_late(function(i) -- it becomes what is left of it, three quarters as large, and grows to the whole
  local tree = forest:get(i)
  falling[i] = tree.scale
  forest:set(i, { kind = tree.kind + 2, glow = 3, color = {1, 1, 1} })
end)
fire:on_burned(function(i, t)
  glowing[i] = t
  forest:set(i, { state = {fire.lit[i], t} }) -- sooner than was thought, where it was put out
end)
local batch = 8 -- frames in which all that burn get darker once
fx:on_frame(function(t)
  for k = #singed - (math.floor(t * fx.fps + 0.5) % batch), 1, -batch do
    local i = singed[k]
    local left = 1 - 0.85 * fire:progress(i)
    if falling[i] or fire:state(i) == "burned" then table.remove(singed, k) else forest:set(i, { color = {left, left * left, left ^ 3} }) end
  end
  for i, scale in pairs(falling) do
    local share = math.min(math.max(1 + (t - fire.ends[i]) / 0.5, 0), 1)
    forest:set(i, { scale = scale * (0.75 + 0.25 * share) })
    if share == 1 then falling[i] = nil end
  end
  for i, since in pairs(glowing) do
    local glow = 3 * math.exp((since - t) / 8)
    if glow < 0.01 then glow, glowing[i] = 0, nil end
    forest:set(i, { glow = glow })
  end
  fx:status("burning", fire.burning, "trees")
  fx:status("burned", fire.burned, "trees")
end)

local function light(event) if event.hit then fire:ignite_near(event.hit.position, 9) end end
fx:on_click(light, "set fire to the nearest tree")
fx:on_key("f", light, "the same, under the pointer")
fx:on_key("n", function() night:set(1 - night:get()) end, "night, or dusk again")
fx:on_key("w", function() local w = wind:get(); wind:set { -w[2], w[1], 0 } end, "turn the wind to the left")
fx:on_key("x", function() for i = 1, #forest do fire:put_out(i) end end, "put it out")
fx.events = { { 0.5, click = {-32, 10, 0} }, { 1.5, click = {-14, 34, 6} } }

-- ---- flames, smoke and light, of all trees together -------------------------------------------------------

local since, left = time - instance_state.x, instance_state.y - time
local burning  = smoothstep(0, 2.5, since) * smoothstep(-0.5, 2, left)
local smoking  = smoothstep(0.5, 3, since) * smoothstep(-14, 0, left)
local gusts    = curl { frequency = 0.5, octaves = 1, speed = 0.6 }
local skirts   = box { position = {0, 0, 3}, size = {3.6, 3.6, 5.6} } * (1.7 - 0.27 * position.z - length(vec(x, y, 0))) -- a cone

local flames = particles {
  at = forest, share = burning, rate = 320, count = 262144, lifetime = {0.35, 0.9}, shape = skirts, threshold = 0, seed = 2,
  velocity = wind * 0.8 + vec(0, 0, 6) + gusts * 2.4, motion = "carried",
}
local smoke = particles {
  at = forest, share = smoking, rate = 14, count = 131072, lifetime = {9, 15}, position = {0, 0, 5}, radius = 1.5, seed = 4,
  velocity = wind + vec(0, 0, 4.2) * over_age { {0, 1}, {0.4, 0.5}, {1, 0.2} } + gusts * 2, motion = "carried",
}
local sparks = particles {
  at = forest, share = burning, rate = 3, count = 8192, lifetime = {1.5, 4}, position = {0, 0, 4}, radius = 1.5, seed = 6,
  velocity = wind * 1.3 + vec(0, 0, 3.2) + gusts * 4, motion = "carried",
}
local ash = particles { -- lies where it falls
  at = forest, share = burning, rate = 3, count = 131072, lifetime = 60, velocity = {0, 0, 0}, motion = "carried", seed = 7,
  shape = box { size = {7, 7, 1} } * (3.4 - length(vec(x, y, 0))), threshold = 0,
}

-- What is near is drawn particle by particle; all of it together is a coarse grid, for the smoke and its light.
-- A cell of it is 1.7 m wide. What is put into it is at least two cells large, else the cells show as blocks.
local sky_box = { min = {-60, -40, 0}, max = {100, 110, 62} }
local air  = deposit { smoke, box = sky_box, resolution = 96, size = over_age { {0, 3.4}, {0.3, 4.2}, {1, 5.5} }, opacity = over_age { {0, 0}, {0.04, 0.2}, {0.3, 0.25}, {1, 0.08} } }
local heat = deposit { flames, box = sky_box, resolution = 96, size = 3.4, opacity = over_age { {0, 0.09}, {1, 0.02} } }
local bed  = deposit { ash, box = { min = {-66, -40, -1}, max = {78, 80, 26} }, resolution = 112, size = 1.1, opacity = 1.6 }

local lumps  = worley { frequency = 0.22, octaves = 3, persistence = 0.55, drift = {-1.2, -0.5, -1.2}, seed = 11 }:tile { resolution = 96, octaves = 2 }
local medium = lighting {
  density = air.density * smoothstep(0.2, 0.6, lumps) * soot * 1.5, emission = vec(1, 0.33, 0.06) * heat.density * blaze * 0.5,
  albedo = {0.42, 0.38, 0.35}, anisotropy = 0.4, shadow_resolution = 64, sampling = "linear", fire_lights = 0,
}
local lamps = point_lights {
  at = forest, position = {0, 0, 3.4}, color = {1, 0.42, 0.11}, range = 17, radius = 0.8,
  power = burning * blaze * 900 * (0.75 + 0.5 * perlin { frequency = 1, w = 5 * time, dimensions = 4 }),
}

-- ---- the picture ------------------------------------------------------------------------------------------

local scene   = geometry { lod = 0.7, mesh { "data/valley.obj" }, water, forest, floor }
local shadows = shadow_maps { from = scene, points = 0, distance = 160, lod = 1 }
local colors  = shader { "burnt_ground.comp", albedo = scene.albedo, depth = scene.depth, burnt = bed.density }
local solid   = shade { albedo = colors.color, from = {scene, medium, lamps, shadows}, haze = 0.0012,
                        model = look == "drawn" and "toon" or "physical" }
if look == "drawn" then solid = over { outline { from = scene, thickness = 3, reach = 250 }, solid } end

-- Flames are drawn as particles below. In the grid they light the smoke and the ground, and are not seen.
local volume = march { from = {medium, scene}, emission = {0, 0, 0}, steps = 40, jitter = 0.5, resolution = 0.35 }
local tongue = palette { {0, {2.0, 0.72, 0.13}}, {0.35, {1.8, 0.38, 0.03}}, {0.7, {0.9, 0.11, 0.01}}, {1, {0, 0, 0}} }
local near   = splats {
  from = {flames, scene, medium}, size = over_age { {0, 0.3}, {0.3, 0.6}, {1, 0.08} }, color = tongue(particle_age).rgb * 1.3 * blaze,
  streak = 0.12, soften = 0.3,
}
local flying = splats { from = {sparks, scene}, size = 0.02 + 0.05 * particle_random * particle_random, color = vec(1, 0.35, 0.06) * over_age { {0, 1}, {1, 0} }, brightness = 90, streak = 0.04 }

local picture = over { volume, solid, from = {volume, scene} }
picture = over { near, picture, from = {near, scene} }
picture = over { flying, picture, from = {flying, scene} }
local halo  = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown = final { source = picture, bloom = halo, bloom_intensity = 0.22, exposure_ev = 0.3, tonemap = "agx", saturation = 1.15 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
