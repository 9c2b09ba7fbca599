-- A camp fire as a drawn film, twelve pictures a second: light in flat bands, flames of four colours, ink
-- along the edges. Half of the time it is shown as it is, so that a line sweeps over the picture and
-- draws what lies behind it, and bloom comes and goes (the close-up of FireGL, 2025, which cycles both).
--
--   roil render effects/toon_fire.lua --frames 60 -o drawn.png
--   roil render effects/toon_fire.lua --frames 60 --set toon=off -o plain.png
--   roil render effects/toon_fire.lua --frames 60 --set colours=2 --set thickness=7 -o comic.png
--
-- What makes a picture look drawn: shade with model = "toon" cuts the light of each lamp into bands; bands
-- does the same for what was marched, and gives each band the colour of a palette; outline inks where
-- depth jumps and where surfaces turn. None of them knows of the others.

local fx = effect { name = "toon_fire", fps = 12, frames = 144, author = "the roil authors", licence = "MIT" }

local toon      = param { "toon", "cycle", words = {"cycle", "on", "off"}, help = "whether it is drawn: by the timeline, always or never" }
local glow      = param { "glow", "cycle", words = {"cycle", "on", "off"}, help = "whether what is bright blooms" }
local colours   = param { "colours", 4, min = 1, max = 12, integer = true, help = "bands of the flames" }
local shades    = param { "shades", 3, min = 1, max = 12, integer = true, help = "bands of the light on what stands around" }
local thickness = param { "thickness", 2.4, min = 0, max = 20, help = "of the ink lines, pixels of a picture of 1080 rows" }
local height    = param { "height", 1.7, min = 0.3, max = 3, unit = "m", help = "of the flames" }
local brightness = param { "brightness", 100, min = 0, max = 500, unit = "W", help = "light of the fire" }
local smoke     = param { "smoke", 0.8, min = 0, max = 3, help = "how much of it rises" }

-- ---- the timeline: 12 s, in quarters ------------------------------------------------------------

-- Drawn in the second and third quarter, going over to it in half a second; bloom in the last two.
local function eased(t, from) return math.min(math.max((t - from) / 0.5, 0), 1) end
local function drawn_at(t)
  local now = t % 12
  if toon:get() ~= "cycle" then return toon:get() == "on" and 1 or 0 end
  return eased(now, 3) - eased(now, 9)
end
local function glow_at(t)
  if glow:get() ~= "cycle" then return glow:get() == "on" and 1 or 0 end
  return eased(t % 12, 6) - eased(t % 12, 11.5)
end

-- ---- the fire -----------------------------------------------------------------------------------

-- Tongues: drops that are widest low down and run out in a point, each of which reaches up and falls back
-- in its own time. Cells that rise eat at them, and a curl bends them the more, the higher it is. Such noise
-- need not be sampled along every ray: it is baked once a picture.
local function tongue(x, y, wide, tall, pace, phase)
  local rise   = position.z / (height * tall * (0.74 + 0.26 * sin(pace * time + phase)))
  local waist  = wide * smoothstep(-0.15, 0.18, rise) * (1 - rise)
  return clamp(1 - length(vec(position.x - x * (1 - rise), position.y - y * (1 - rise), 0)) / max(waist, 0.001), 0, 1)
end
local body = tongue(0, 0, 0.48, 1, 4.1, 0)
for _, t in ipairs { {-0.22, 0.02, 0.30, 0.86, 5.3, 1.1}, {0.23, 0.05, 0.29, 0.78, 6.1, 2.9}, {0.04, -0.20, 0.26, 0.60, 5.7, 4.4}, {-0.06, 0.20, 0.28, 0.72, 4.7, 0.6} } do
  body = max(body, tongue(table.unpack(t)))
end
local tongues  = worley { frequency = 3.2, octaves = 2, persistence = 0.5, drift = {0, 0, -1.6}, speed = 0.5, seed = 11 }:transform { scale = {1, 1, 1.7} }
local licks    = curl { frequency = 1.7, octaves = 2, persistence = 0.55, drift = {0, 0, -1.9}, speed = 0.4, seed = 5 }
local shape    = body * (0.2 + 1.7 * tongues)
local room     = { min = {-0.8, -0.8, 0}, max = {0.8, 0.8, 2.6} }
local flames   = bake(clamp(shape, 0, 1):warp(licks, 0.20 * smoothstep(0.05, 0.8, position.z / height)), { size = {64, 64, 104}, box = room })

-- Smoke in puffs, each of which is a cell that swells on its way up.
local plume    = 0.16 + 0.26 * smoothstep(1.0, 4.0, position.z)
local puffs    = worley { frequency = 1.9, octaves = 2, persistence = 0.45, drift = {0, 0, -0.75}, speed = 0.2, seed = 23 }
local column   = max(1 - length(vec(position.x + 0.16 * (position.z - 1), position.y - 0.1 * (position.z - 1), 0)) / plume, 0)
local swirl    = curl { frequency = 0.9, octaves = 2, drift = {0, 0, -0.6}, seed = 8 }
local fade     = smoothstep(1.0, 1.6, position.z) * (1 - smoothstep(2.4, 4.3, position.z))
local cloud    = bake((smoothstep(0.28, 0.62, column * (0.3 + 1.2 * puffs)) * fade):warp(swirl, 0.22),
                      { size = {64, 64, 104}, box = { min = {-1.6, -1.2, 0.8}, max = {1.0, 1.4, 4.6} } })

-- It flickers from picture to picture, not smoothly: somebody drew it.
local function flicker(t)
  local n = math.floor(t * 12 + 0.5)
  return 1 + 0.14 * math.sin(2.1 * n) + 0.08 * math.sin(5.3 * n + 1)
end

-- ---- the camp -----------------------------------------------------------------------------------

fx.camera = camera { eye = curve { {0, {1.15, -4.5, 1.22}}, {12, {0.55, -4.6, 1.30}}, shape = "ease_in_out" }, target = {-0.05, 0, 1.0}, fov = 36, near = 0.05, far = 300 }
fx.sun    = sun { azimuth = 107, elevation = 13, color = {0.42, 0.60, 1}, strength = 0.75, angle = 0.2 } -- the moon
fx.sky    = sky { night = 1, night_zenith = {0.022, 0.040, 0.105}, night_horizon = {0.050, 0.070, 0.150}, stars = 0.55, moon = 5 }
fx.lights = {
  point_light { name = "fire", position = {0, 0, 0.62}, color = {1, 0.50, 0.16}, power = function(t) return brightness:get() * flicker(t) end },
}

local forest = instances {
  mesh { "data/pine.obj" }, mesh { "data/leafy.obj" },
  at = { {-6.2, 6.5, 0}, {-4.6, 9.6, 0}, {-1.0, 12.6, 0}, {0.7, 9.5, 0}, {2.6, 7.0, 0}, {4.6, 8.8, 0}, {6.4, 6.4, 0}, {-8.6, 9.6, 0}, {8.8, 10.5, 0},
         {-3.4, 12.5, 0}, {3.6, 13, 0}, {-6.6, 13.5, 0}, {6.9, 13.5, 0}, {0.2, 15, 0}, {-4.6, 4.4, 0}, {-10.5, 12, 0}, {-13, 14.5, 0}, {11, 15, 0}, {-16, 20, 0}, {15, 20, 0}, {-9.5, 19, 0}, {-8.2, 7.4, 0}, {-12, 9.5, 0} },
  kind = { 1, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 }, scale = {0.8, 1.25}, yaw = {0, 360}, seed = 4,
}
local function apart(x, y, far) return length(vec(position.x - x, position.y - y, 0)) - far end
local undergrowth = instances {
  mesh { "data/tuft.obj" }, mesh { "data/fern.obj" },
  at = scatter { count = 90, size = {11, 8}, distance = 0.5, seed = 9, inside = min(min(min(apart(0, 0, 1.6), apart(0.1, -1.8, 1)), apart(-1.36, -0.55, 0.6)), min(apart(1.62, 0.55, 0.9), apart(-2.35, 2.35, 1.5))) },
  kind = {0.7, 0.3}, scale = {0.45, 1}, yaw = {0, 360}, seed = 5,
}
local scene = geometry {
  mesh { "data/ground.obj", color = {0.95, 0.92, 0.55} }, mesh { "data/logs.obj" },
  mesh { "data/stump.obj", position = {1.62, 0.55, 0}, rotation = {0, 0, 40} }, mesh { "data/axe.obj", position = {1.62, 0.55, 0.43}, rotation = {0, 0, -40} },
  mesh { "data/stick.obj", position = {-1.18, -0.42, 0}, rotation = {0, 0, 20} }, mesh { "data/rock.obj", position = {-1.36, -0.55, -0.1}, scale = 0.42 },
  mesh { "data/tent.obj", position = {-2.35, 2.35, 0}, rotation = {0, 0, 38} },
  forest, undergrowth,
}

-- ---- as it is -----------------------------------------------------------------------------------

local heat   = palette { {0.05, {0, 0, 0}}, {0.2, {0.20, 0.035, 0.004}}, {0.45, {1, 0.22, 0.02}}, {0.75, {1.7, 0.62, 0.09}}, {1, {2, 1.2, 0.35}} }
local solid  = shade { name = "plain", from = scene }
local fire   = march { name = "fire", density = flames * 0.8, albedo = {0, 0, 0}, radiance = heat(flames * 1.3).rgb * 6, from = scene, steps = 48, jitter = 0.5 }
local grey   = march { name = "grey", density = cloud * smoke * 1.4, radiance = {0.03, 0.035, 0.05}, from = scene, steps = 40, jitter = 0.5, resolution = 0.5 }
local plain  = over { fire, over { grey, solid, from = {grey, scene} }, from = {fire, scene} }

-- ---- as it is drawn -----------------------------------------------------------------------------

-- The same volumes, but what is marched only counts how much flame and smoke a ray meets.
local flat   = shade { name = "flat", from = scene, model = "toon", toon_levels = shades }
local much   = march { name = "much", density = flames * 1.5, radiance = vec(1, 1, 1) * flames * flames * 8, from = scene, steps = 48, jitter = 0 }
local thick  = march { name = "thick", density = cloud * smoke * 3, radiance = {1, 1, 1}, from = scene, steps = 40, jitter = 0, resolution = 0.5 }
local paint  = palette { {0, {0.62, 0.035, 0.012}}, {0.36, {1, 0.16, 0.012}}, {0.66, {1, 0.48, 0.035}}, {1, {1, 0.88, 0.42}} }
local ashes  = palette { {0, {0.030, 0.036, 0.062}}, {1, {0.072, 0.080, 0.120}} }
local flame  = bands { name = "flame", much, levels = colours, low = 0.12, high = 2.4, curve = 1, color = paint(position.y).rgb }
local puff   = bands { name = "puff", thick, of = "opacity", levels = 2, low = 0.12, high = 0.8, color = ashes(position.y).rgb, opacity = 0.85 }
local ink    = outline { name = "ink", from = scene, side = "outside", color = {0.012, 0.010, 0.022}, thickness = thickness, normal_threshold = 55, reach = 26 }
local drawn  = over { flame, over { puff, over { ink, flat } } }

-- ---- embers, bloom, and from one to the other ------------------------------------------------------

local embers = particles {
  count = 512, rate = 34, lifetime = {0.9, 2.6}, seed = 4, position = {0, 0, 0.5}, radius = 0.25, warm_up = 2,
  velocity = curl { frequency = 1.3, speed = 0.5, seed = 9 } * 0.55 + {-0.1, 0.05, 0.85},
}
local sparks = splats {
  from = {embers, scene}, size = (0.5 + particle_random) * over_age { {0, 0.020}, {0.7, 0.014}, {1, 0.004} },
  color = over_age { {0, {1, 0.62, 0.16}}, {0.5, {1, 0.30, 0.05}}, {1, {0.5, 0.05, 0.01}} }, brightness = 3,
}

-- The bloom is the published one: what is brighter than a threshold, five passes of nine taps, added the
-- less the brighter the picture is already, saturation 0.9.
local function finish(name, picture, threshold, strength, map, stops)
  local lit  = over { name = name .. "_sparks", sparks, picture }
  local halo = bloom { name = name .. "_bloom", bright { name = name .. "_bright", lit, mode = "paper", threshold = threshold }, mode = "gaussian", passes = 5, resolution = 0.25 }
  return final {
    name = name .. "_final", source = lit, bloom = halo, bloom_mix = "luminance", tonemap = map, exposure_ev = stops, saturation = 0.9,
    bloom_intensity = function(t) return strength * glow_at(t) end,
  }
end
local as_it_is = finish("plain", plain, 0.8, 0.5, "aces", 1.0)
local as_drawn = finish("drawn", drawn, 0.25, 0.8, "none", 0)
local shown    = shader { "toon_fire.comp", name = "sweep", before = as_it_is.color, after = as_drawn.color, share = drawn_at }

fx.output = shown
fx.depth  = scene.depth
return fx
