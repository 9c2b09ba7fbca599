-- A fuel-air burst on open ground, played back from a baked OpenVDB sequence of only 32 x 32 x 32
-- voxels. Noise, worked into density and fire, gives back the detail that so coarse a grid lost.
--
--   roil render effects/explosion.lua --frames 30 -o explosion.png
--   roil render effects/explosion.lua --frames 30 -o perlin.png --set noise=perlin
--   roil info params effects/explosion.lua          -- what --set can change

local fx = effect { name = "explosion", fps = 24, frames = 100, author = "the roil authors", licence = "MIT" }

-- Everything you may want to turn, with its range: --set density=30
local density    = param { "density", 40, min = 0, max = 200, unit = "1/m", help = "extinction where the grid's density is 1" }
local brightness = param { "brightness", 3.5, min = 0, max = 50, help = "factor of the fire's light" }
local kelvin     = param { "kelvin", 1400, min = 500, max = 3000, unit = "K", help = "temperature where the grid says 1" }
local noise      = param { "noise", "worley_curl", words = {"worley_curl", "worley", "perlin", "simplex", "none"}, help = "what the detail is made of" }
local detail     = param { "detail", 1.6, min = 0, max = 3, help = "how much the noise eats from the smoke's edges" }
local turbulence = param { "turbulence", 0.27, min = 0, max = 2, unit = "m", help = "how far the flow displaces the grid" }
local steps      = param { "steps", 192, min = 8, max = 1024, integer = true, help = "samples along each ray" }

-- The grids of the sequence are fields: values in space that arithmetic combines.
local burst = vdb { "data/explosion-32/*.vdb", fps = 24, blend = true }

-- A divergence-free flow tears at the grid. It is smooth, so a small baked grid of it will do.
local flow = bake(curl { frequency = 0.7, octaves = 2, persistence = 0.6, speed = 0.4, seed = 3 },
                  { size = {48, 48, 48}, box = burst.box })

-- The torn grids, interpolated smoothly once a voxel, so that the march needs one fetch a sample.
local torn = bake(vec(burst.density, burst.temperature, burst.flame):warp(flow, turbulence),
                  { size = {80, 80, 80}, box = burst.box })
local smoke, heat, flame = torn.x, torn.y, torn.z

-- The detail: lumps at three scales that rise with the smoke. Which noise it is, is structure: it is
-- chosen when the effect loads. As a tile it is computed once, into voxels that repeat: two octaves
-- lie in them, and a sample for the others, at other scales, costs much less than the noise.
local shape = { frequency = 1.4, octaves = 5, persistence = 0.66, lacunarity = 2.1, drift = {0, 0, -0.5}, seed = 11 }
local voxels = { resolution = 128, cells = 9, octaves = 2 }
local kinds = {
  worley_curl = function() return worley(shape):tile(voxels):warp(flow, 0.25) end,
  worley      = function() return worley(shape):tile(voxels) end,
  perlin      = function() return perlin(shape):tile(voxels):remap(0.25, 0.75, 0, 1) end,
  simplex     = function() return simplex(shape):tile(voxels):remap(0.25, 0.75, 0, 1) end,
  none        = function() return 0.5 end,
}
local lumps = kinds[noise:get()]()

-- Lumps stand out where the smoke is thin; the thick core is left alone. As it ages it thins out, and
-- is eaten less, so that it fades instead of falling to pieces.
local fade  = curve { {0, 1}, {1.7, 1}, {3.2, 0.55}, shape = "ease_in_out" }
local thin  = curve { {0, 1}, {1.7, 1}, {2.8, 0.65}, shape = "ease_in_out" }
local eaten = detail * fade
local cover = clamp(smoke * 2.2, 0, 1)
local crust = smoothstep(0, 0.15, cover - eaten * (1 - lumps) * (1 - 0.6 * cover))
local soot  = cover * crust * (smoke + 0.15) * density * thin

-- A black body is white where it is very hot, as the first fire is all over. After a flash it is shown
-- colder than it is, so that it keeps its colour and its folds.
local young = curve { {0, 1.3}, {0.09, 0.95}, {0.2, 0.62}, {0.4, 0.68}, {0.8, 0.88}, {1.1, 1}, shape = "ease_in_out" }
local fire  = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }

-- It strikes the ground: a ring of dust runs outwards, rises a little and thins out.
local way   = position - vec(4, 4, 0)
local far   = length(way * vec(1, 1, 0))
local front = curve { {0, 0.3}, {0.15, 2}, {0.5, 3.1}, {1.5, 3.9}, {4, 4.4}, shape = "cubic" }
local high  = curve { {0, 0.3}, {0.4, 0.75}, {4, 1.4} }
local dusty = curve { {0, 0}, {0.1, 12}, {0.8, 7}, {4, 0}, shape = "ease_out" }
local ring  = min(front - far, (high - position.z) * 1.2) - (1 - lumps)
local dust  = box { position = {4, 4, 0.7}, size = {9, 9, 1.4} } * smoothstep(0, 0.5, ring) * smoothstep(0, 2.2, far) * dusty

fx.camera = camera { eye = {4, -12, 3.36}, target = {4, 4, 3.36}, fov = 31.89, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239, elevation = 34, color = {1, 0.93, 0.82}, strength = 4.6 }
fx.sky    = sky { zenith = {0.10, 0.24, 0.58}, horizon = {0.50, 0.60, 0.72}, strength = 0.6 }

-- What fills space, and what light reaches where in it: sun and sky through the smoke, the fire on the
-- smoke around it, and all that is scattered on the way.
local lit = lighting {
  density    = soot + dust,
  emission   = fire(heat * (0.15 + 1.35 * lumps) * kelvin * young) * flame * brightness,
  albedo     = {0.52, 0.52, 0.52},
  tint       = mix(vec(0.87, 0.83, 0.79), vec(1, 0.84, 0.67), clamp(dust / max(soot + dust, 0.001), 0, 1)),
  anisotropy = 0.2,
  sampling   = "linear",
}

-- Stones and clods of earth are thrown up, fall, and stay where they come to rest.
local debris = particles {
  count = 300, burst = 300, burst_time = 0.04, lifetime = 10, seed = 5, position = {4, 4, 0.2}, radius = 0.7,
  speed = {0, 0, 13}, spread = 75, variation = 0.85, drag = 0.7,
  gravity = 9.81, collide = position.z, clearance = 0.02, bounce = 0.25, friction = 0.7,
}

-- What is solid, in the same light: the smoke's shadow lies on it, and so does the fire's glow. The ground
-- is black where fire lay on it.
local scene  = geometry { mesh { "data/ground.obj" }, mesh { "data/crates.obj" } }
local scorch = smoothstep(2.6, 0.8, far + 0.8 * lumps) * curve { {0.05, 0}, {0.6, 2} }
local ground = shader { "burnt_ground.comp", albedo = scene.albedo, depth = scene.depth, burnt = scorch, lift = 0 }
local chunks = pieces {
  debris, mesh { "data/rock.obj" }, scene_albedo = ground.color, from = scene, color = {0.7, 0.48, 0.33},
  size = 0.06 + 0.26 * particle_random ^ 8, angle = 900 * (particle_random - 0.5) * over_age { {0, 0}, {0.15, 1}, {1, 1} },
}
local solid  = shade { from = {chunks, scene, lit}, haze = 0.002 }

-- Samples are moved by half a step at random: what would be rings between them becomes a grain that is
-- too fine to see.
local volume = march { from = {lit, chunks}, steps = steps, jitter = 0.5, resolution = 0.5 }

local picture = over { volume, solid, from = {volume, chunks} }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.35, exposure_ev = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = chunks.depth
return fx
