-- Step 10: a pass of your own. step-10-blast.comp throws sparks.
--
--   roil render effects/step-10-explosion.lua --frames 20 -o explosion.png

local fx = effect { name = "step_10", fps = 24, frames = 100 }

-- What you may want to turn. Each is a slider in `roil live`, and a --set of `roil render`.
local density = param { "density", 20, min = 0, max = 100, unit = "1/m", help = "how thick the smoke is" }
local eaten   = param { "eaten", 0.9, min = 0, max = 2, help = "how much the noise eats from the smoke's edges" }
local tearing = param { "tearing", 0.12, min = 0, max = 2, unit = "m", help = "how far the flow displaces the grid" }
local glow    = param { "glow", 4, min = 0, max = 100, help = "factor of the fire's light" }
local kelvin  = param { "kelvin", 1400, min = 500, max = 3000, unit = "K", help = "temperature where the grid says 1" }
local steps   = param { "steps", 96, min = 8, max = 512, integer = true, help = "samples along each ray" }

-- Z is up and lengths are metres. The camera circles a point above the middle of the ground. The sun
-- stands low on its left, and the sky is what dusk leaves of it.
fx.camera = orbit { target = {0, 0, 3.1}, distance = 16, pitch = 5, fov = 32 }
fx.sun    = sun { azimuth = 195, elevation = 17, color = {1, 0.72, 0.45}, strength = 3 }
fx.sky    = sky { zenith = "#14418f", horizon = "#a3a2aa", strength = 0.25 }

-- A hundred frames of 32 x 32 x 32 voxels, 8 m a side. Each grid in the files is a field.
local burst = vdb { "data/explosion-32/*.vdb", fps = 24, blend = true, offset = {-4, -4, 0} }
local flow  = curl { frequency = 0.7, octaves = 2, seed = 3, speed = 0.4 }
local torn  = bake(vec(burst.density, burst.temperature, burst.flame):warp(flow, tearing), { size = 80, box = burst.box })
local smoke, heat, flame = torn.x, torn.y, torn.z

-- Lumps stand out at the edges, where the smoke is thin; its thick core is left alone.
local lumps = worley { frequency = 1.4, octaves = 4, persistence = 0.55, seed = 11, drift = {0, 0, -0.5} }:warp(flow, 0.25)
local cover = clamp(smoke * 3, 0, 1)
local body  = cover * smoothstep(0, 0.15, cover - eaten * (1 - lumps) * (1 - 0.7 * cover)) * (smoke + 0.15)

-- The glow of hot soot, which grows with the fourth power of its temperature in kelvin.
local fire  = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }

local scene  = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj", position = {-4, -4, 0} },
}

-- What light reaches where, worked out once a frame: through the smoke, past the crates, from the fire.
local lit    = lighting {
  density    = body * density,
  emission   = fire(heat * (0.45 + 0.85 * lumps) * kelvin) * flame * glow,
  albedo     = {0.45, 0.43, 0.41},
  anisotropy = 0.3,
  sampling   = "linear", -- the bake is smooth already
}
local solid  = shade { from = {scene, lit}, haze = 0.004 }
local volume = march {
  from       = {lit, scene},
  steps      = steps,
  resolution = 0.5, -- a quarter of the rays; `over` scales up along the edges of the scene
}

local picture = over { volume, solid, from = {volume, scene} }
local blast   = shader {
  "step-10-blast.comp", picture, scene.depth,
  position = {0, 0, 0.5},
  speed    = 14,
}
local halo    = bloom { bright { blast, threshold = 1 }, radius = 0.75 }
fx.output = final { blast, halo, bloom_intensity = 0.5, exposure_ev = 0.5, tonemap = "reinhard" }.color
return fx
