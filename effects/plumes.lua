-- Two thin plumes by night, blue-white and rosy, and coloured lamps between them: each lamp lights both
-- plumes and the ground, through the smoke, and each plume stands in the other's light.
--
--   roil render effects/plumes.lua --frames 60 -o plumes.png
--   roil render effects/plumes.lua --frames 60 --set lamps=0 --set moon=4 -o moonlit.png

local fx = effect { name = "plumes", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

-- What you may want to turn. Each is a slider in `roil live`, and a --set of `roil render`.
local density = param { "density", 7, min = 0, max = 20, unit = "1/m", help = "how thick the smoke is" }
local lamps   = param { "lamps", 1, min = 0, max = 10, help = "factor of the lamps' power" }
local moon    = param { "moon", 0.12, min = 0, max = 10, unit = "W/m^2", help = "light of the moon" }
local rise    = param { "rise", 1.6, min = 0, max = 10, unit = "widths/s", help = "how fast the smoke leaves the ground" }
local apart   = param { "apart", 2.8, min = 1, max = 4, unit = "m", help = "distance of the plumes" }
local colors  = { param { "left", {0.72, 0.86, 1}, color = true, help = "of the left plume's smoke" },
                  param { "right", {1, 0.78, 0.74}, color = true, help = "of the right plume's smoke" } }

-- A plume in a space of its own, where it is straight and of radius 1 (effects/plume.lua says more).
local mouth, widening, height = 0.16, 0.13, 6.5
local function plume(side, seed)
  local z      = max(position.z, 0)
  local sway   = vec(sin(0.9 * z - 0.8 * time + seed), sin(0.7 * z - 0.6 * time + 2 * seed), 0) * 0.05 * z
  local wide   = mouth + widening * z
  local across = (position - sway - vec(0.5 * side * apart, 0, 0)) / wide
  local room   = vec(across.x, across.y, wide ^ 0.15 / (0.15 * widening))
  local radius = length(vec(position.x, position.y, 0))
  local stream = vec(0, 0, 0.3 + 0.7 * exp(-1.2 * radius * radius)) * rise + curl { frequency = 0.5, seed = seed + 1, amount = 0.4 }
  local lumps  = worley { frequency = 0.6, octaves = 3, persistence = 0.5, seed = seed }:tile()
                 :warp(curl { frequency = 0.8, octaves = 2, seed = seed }:tile(), 0.3):advect(stream, { period = 2.4, mean = 0.48 })
  local function there(f) return f:warp(room - position) end
  local young  = smoothstep(height, 0.2 * height, position.z)
  local depth  = there(1 - radius + 2.2 * (lumps - 0.5)) - 0.5 * (1 - young)
  local near   = 1 - smoothstep(1.7, 2.1, there(radius))
  return near * smoothstep(0, 0.45, depth) * step(0, position.z) * (0.15 + 0.85 * young)
end

local box    = { min = {-3.8, -1.8, 0}, max = {3.8, 1.8, height} }
local eddies = curl { frequency = 2.2, octaves = 3, persistence = 0.6, seed = 9, drift = {0, 0, -1.2}, speed = 0.6 }:tile()
local both   = bake(vec(plume(-1, 7), plume(1, 31), 0), { size = {144, 68, 124}, box = box }):warp(eddies, 0.05)
local smoke  = both.x + both.y
local hue    = mix(colors[1], colors[2], both.y / smoke)

-- Lamps hang between the plumes and swing: a light's numbers may be functions of the time. What is seen
-- of a lamp is a little gas that glows.
local bulbs, glowing = 0, vec(0, 0, 0)
local function lamp(color, power, x, y, z, phase)
  local function swing(t) return {x + 0.3 * math.sin(1.3 * t + phase), y + 0.2 * math.cos(1.1 * t + phase), z} end
  local bulb = sphere { position = swing, radius = 0.17, falloff = 0.17 }
  bulbs   = bulbs + bulb
  glowing = glowing + bulb ^ 3 * lamps * 60 * color
  return point_light { position = swing, color = color, power = power * lamps }
end
fx.lights = {
  lamp({1.0, 0.40, 0.08}, 220, -0.3, -0.4, 0.8, 0),
  lamp({0.06, 0.60, 1.0}, 320, 0.3, -0.2, 2.5, 2),
  lamp({1.0, 0.10, 0.50}, 320, -0.3, -0.3, 4.3, 4),
}
fx.sun    = sun { azimuth = 70, elevation = 40, color = {0.75, 0.85, 1}, strength = moon }
fx.sky    = sky { zenith = {0.004, 0.007, 0.018}, horizon = {0.012, 0.016, 0.03}, strength = 1 }
fx.camera = camera { eye = {0, -12, 2.0}, target = {0, 0, 2.9}, fov = 32, near = 0.1, far = 500 }

local lit    = lighting { density = smoke * density + 0.5 * bulbs, tint = hue, emission = glowing, fire_lights = "0", albedo = {1, 1, 1}, anisotropy = 0.2 }
local scene  = geometry { mesh { "data/ground.obj" } }
local solid  = shade { from = {scene, lit}, haze = 0.004 }
local volume = march { from = {lit, scene}, steps = 128 }

local picture = over { volume, solid, from = {volume, scene} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.3, exposure_ev = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
