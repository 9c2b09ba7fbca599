-- Two containers of particles: a fire with its smoke, and a rainbow over it. A container is one object,
-- drawn by one call however much is in it. Where a particle is, its colour and its size are fields that
-- are asked for each; what stands there is a choice: a spot that faces the eye, or a mesh.
--
--   roil render effects/containers.lua --frames 48 -o rainbow.png
--   roil render effects/containers.lua --frames 48 --set drawn_as=meshes -o beads.png
--
-- Play with `arch`, `bow`, `grain` and `flutter`, with `count`, and with the stops of `colors`.

local fx = effect { name = "containers", fps = 24, frames = 144, author = "the roil authors", licence = "MIT" }

local drawn_as = param { "drawn_as", "spots", words = {"spots", "meshes"}, help = "what stands at each particle" }
local count    = param { "count", 14000, min = 100, max = 200000, integer = true, help = "particles of the rainbow; taken when the effect loads" }
local arch     = param { "arch", 3.1, min = 1, max = 5, unit = "m", help = "from the foot of the rainbow's middle to its red edge" }
local bow      = param { "bow", 1.0, min = 0.1, max = 1.5, unit = "m", help = "from the red edge to the violet one" }
local grain    = param { "grain", 0.045, min = 0.005, max = 0.2, unit = "m", help = "size of a particle of the rainbow" }
local flutter  = param { "flutter", 0.12, min = 0, max = 2, unit = "m/s", help = "of the air that carries it" }

fx.camera = camera { eye = {0, -10.5, 1.3}, target = {0, 0, 1.65}, fov = 34, near = 0.1, far = 300 }
fx.sun    = sun { azimuth = 205, elevation = 22, color = {1, 0.82, 0.6}, strength = 2.6 }
fx.sky    = sky { zenith = {0.030, 0.045, 0.075}, horizon = {0.16, 0.17, 0.20}, strength = 1 }
fx.lights = {
  point_light { position = {0, -0.1, 0.7}, color = {1, 0.45, 0.12}, power = function(t) return 320 + 60 * math.sin(17 * t) + 40 * math.sin(31 * t) end },
}

local woods = instances {
  mesh { "data/pine.obj" }, mesh { "data/leafy.obj" },
  at = scatter { count = 60, size = {44, 20}, position = {0, 14, 0}, distance = 2.1, seed = 4 },
  kind = {0.8, 0.2}, scale = {0.75, 1.4}, yaw = {0, 360}, seed = 4,
}
local scene = geometry { mesh { "data/ground.obj", color = {0.6, 0.7, 0.4} }, mesh { "data/logs.obj" }, woods }

-- ---- what is in them -----------------------------------------------------------------------------

-- A rainbow is born all over its arch, and carried round it. How far out a particle is says its colour.
local far    = length(vec(position.x, 0, position.z))
local place  = (arch - far) / bow -- 0: red, 1: violet
local around = vec(position.z, 0, -position.x) / max(far, 0.1)
local bowed  = particles {
  count = count:get(), rate = count:get() / 3, lifetime = {2, 4}, seed = 3, warm_up = 4,
  shape = box { position = {0, 0, 2.6}, size = {10.4, 0.3, 5.2} } * step(0, place) * step(place, 1),
  velocity = around * 0.25 + curl { frequency = 0.8, speed = 0.4, seed = 6 } * flutter,
}
local colors = palette {
  {0, {1, 0.02, 0.01}}, {0.17, {1, 0.22, 0.01}}, {0.33, {1, 0.75, 0.02}}, {0.5, {0.06, 0.7, 0.05}},
  {0.67, {0.02, 0.4, 0.9}}, {0.83, {0.06, 0.06, 0.9}}, {1, {0.35, 0.03, 0.7}}, space = "oklab",
}

-- A fire is what it begins as: flames become smoke as they grow older and larger.
local flames = particles {
  count = 8192, rate = 1500, lifetime = {0.9, 3.2}, seed = 8, warm_up = 4,
  position = {0, 0, 0.3}, radius = 0.4,
  velocity = vec(0.22 * position.z, 0, 1.15) - vec(position.x, position.y, 0) * (0.55 * smoothstep(1, 0.3, position.z))
             + curl { frequency = 1.1, octaves = 2, speed = 0.8, drift = {0, 0, -0.8}, seed = 2 } * 0.55,
}
local burning = palette { {0, {9, 5, 1.6}}, {0.12, {5, 1.5, 0.2}}, {0.3, {1.4, 0.2, 0.02}}, {0.45, {0.06, 0.05, 0.05}}, {1, {0.10, 0.10, 0.11}} }
local glowing = smoothstep(0.45, 0.1, particle_age)
local swelling = over_age { {0, 0.14}, {0.3, 0.2}, {1, 0.6} }

-- ---- what stands at a particle ---------------------------------------------------------------------

local twinkle = 0.6 + 0.8 * particle_random
local fading  = smoothstep(0, 0.15, particle_age) * smoothstep(1, 0.8, particle_age)

local function as_spots()
  local solid = shade { from = scene, haze = 0.006 }
  local fire = splats {
    name = "fire", from = {flames, scene}, blend = "sorted", size = swelling, color = burning(particle_age).rgb,
    opacity = over_age { {0, 0}, {0.06, 0.6}, {0.4, 0.16}, {1, 0} }, soften = 0.1,
  }
  local rainbow = splats {
    name = "rainbow", from = {bowed, scene}, size = grain * twinkle, color = colors(place).rgb, opacity = fading, brightness = 2.2,
  }
  return over { fire, over { rainbow, solid, from = {rainbow, scene} }, from = {fire, scene} }
end

local function as_meshes()
  local bead = mesh { "data/shard.obj", material = material { name = "bead", color = {1, 1, 1}, specular = 0.6, roughness = 0.3 } }
  local coal = mesh { "data/shard.obj", material = material { name = "coal", color = {1, 1, 1}, emission = {7, 2, 0.25} } }
  local rainbow = pieces { bowed, bead, name = "rainbow", from = scene, size = grain * twinkle * fading * 3.4, color = colors(place).rgb * 0.9, angle = 400 * particle_age }
  local fire = pieces {
    flames, coal, name = "fire", from = rainbow, size = swelling * fading * 0.9, color = vec(0.16, 0.16, 0.17), glow = glowing * glowing, angle = 300 * particle_age,
  }
  return shade { from = fire, haze = 0.006 }
end

local picture = drawn_as:get() == "spots" and as_spots() or as_meshes()
local halo    = bloom { bright { picture, threshold = 1 }, radius = 0.7 }
local shown   = final { source = picture, bloom = halo, bloom_intensity = 0.25, exposure_ev = 0.3, tonemap = "agx", saturation = 1.3 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
