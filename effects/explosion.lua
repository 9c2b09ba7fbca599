-- A fuel-air burst on open ground, played back from a baked OpenVDB sequence of only 32 x 32 x 32
-- voxels. Noise, worked into density and fire, gives back the detail that so coarse a grid lost.
--
--   roil render effects/explosion.lua --frames 30 -o explosion.png
--   roil info params effects/explosion.lua          -- what --set can change

local fx = effect { name = "explosion", fps = 24, frames = 100 }

-- Everything you may want to turn, with its range: --set density=30
local density    = param { "density", 30, min = 0, max = 200, unit = "1/m", help = "extinction where the grid's density is 1" }
local brightness = param { "brightness", 1.6, min = 0, max = 20, help = "factor of the fire's light" }
local detail     = param { "detail", 0.9, min = 0, max = 2, help = "how much the noise eats from the smoke's edges" }
local turbulence = param { "turbulence", 0.12, min = 0, max = 2, unit = "m", help = "how far the flow displaces the grid" }
local steps      = param { "steps", 128, min = 8, max = 1024, integer = true, help = "samples along each ray" }

-- The grids of the sequence are fields: values in space that arithmetic combines.
local burst = vdb { "data/explosion-32/*.vdb", fps = 24, blend = true }

-- A divergence-free flow tears at the grid. It is smooth, so a small baked grid of it will do: one
-- fetch a sample instead of eighteen noises.
local flow = bake(curl { frequency = 0.8, dimensions = "4", speed = 0.4, seed = 3 }, { size = {40, 40, 40}, box = burst.box })

-- Rounded lumps at three scales; they rise with the smoke.
local lumps = worley { frequency = 1.3, octaves = 3, persistence = 0.45, lacunarity = 2.3, drift = {0, 0, 0.5}, seed = 11 }
lumps = lumps:warp(flow, 0.25)

local smoke = burst.density:warp(flow, turbulence)
local heat  = burst.temperature:warp(flow, turbulence)
local flame = burst.flame:warp(flow, turbulence)

-- Lumps stand out where the smoke is thin; the thick core is left alone.
local cover = clamp(smoke * 4, 0, 1)
local body  = smoke * smoothstep(0, 0.35, cover - detail * (1 - lumps) * (1 - 0.6 * cover))

-- The grid's temperature, times 900, is kelvin. A black body's light grows with its fourth power.
local fire = palette { blackbody = {500, 4000}, physical = true, reference = 1500 }

fx.camera = camera { eye = {4, -12, 3.36}, target = {4, 4, 3.36}, fov = 31.89, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 239, elevation = 44, strength = 2.5 }
fx.sky    = sky { zenith = {0.22, 0.32, 0.48}, horizon = {0.30, 0.36, 0.44}, strength = 0.6 }

local scene = geometry {
  mesh { "data/ground.obj" },
  mesh { "data/crates.obj" },
  haze = 0.002,
}

local volume = march {
  density    = body * density,
  emission   = fire(heat * (0.6 + 0.55 * lumps) * 900) * flame * brightness,
  albedo     = {0.45, 0.43, 0.41},
  anisotropy = 0.2,
  sampling   = "quasi_cubic",
  steps      = steps,
  depth      = scene.depth,
  resolution = 0.5,
}

local picture = over { volume = volume.color, edge = volume.edge, source = scene.color, depth = scene.depth }
local glow    = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = glow, bloom_intensity = 0.35, exposure_ev = 0.3, tonemap = "agx" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
