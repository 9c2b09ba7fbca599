-- A chimney's smoke on a clear day: a sunlit column that billows, bends in the wind and disperses. No
-- data at all: one noise, carried by a flow that is faster in the middle of the column than at its rim.
--
--   roil render effects/plume.lua --frames 60 -o plume.png
--   roil render effects/plume.lua --frames 60 --set wind=1.5 -o windy.png

local fx = effect { name = "plume", fps = 24, frames = 240, author = "the roil authors", licence = "MIT" }

-- What you may want to turn. Each is a slider in `roil live`, and a --set of `roil render`.
local density = param { "density", 9, min = 0, max = 50, unit = "1/m", help = "how thick the smoke is" }
local rise    = param { "rise", 2.6, min = 0, max = 20, unit = "widths/s", help = "how fast it leaves the chimney" }
local wind    = param { "wind", 1, min = 0, max = 1.5, help = "how far the wind bends the column" }
local billows = param { "billows", 1.8, min = 0, max = 4, help = "how deep its lumps are, in radii of the column" }
local ragged  = param { "ragged", 0.1, min = 0, max = 1, unit = "m", help = "how far small eddies tear at its edges" }

-- The column begins in the chimney and widens evenly; the higher, the further the wind has carried it.
local mouth, widening, height = 0.4, 0.24, 16
local z     = max(position.z - 5.6, 0)
local axis  = wind * z ^ 1.6 * {0.1, 0.02, 0}
local wide  = mouth + widening * z

-- Its own space: there the column is straight, of radius 1, and as fine at the top as at the bottom.
-- (The height there is the logarithm of the width; a small power is as good.)
local across = (position - axis) / wide
local column = vec(across.x, across.y, wide ^ 0.15 / (0.15 * widening))
local function in_column(f) return f:warp(column - position) end

-- In that space: what rises fast in the middle and slowly at the rim rolls over, again and again. Such
-- a flow would soon draw any noise out into threads; `advect` makes the pattern anew before it does.
local radius = length(vec(position.x, position.y, 0))
local stream = vec(0, 0, 0.3 + 0.7 * exp(-1.2 * radius * radius)) * rise
             + curl { frequency = 0.6, seed = 2, amount = 0.35 }
local lumps  = worley { frequency = 0.72, octaves = 3, persistence = 0.45, lacunarity = 2.2, seed = 5 }
               :tile():advect(stream, { period = 2.4, mean = 0.48 })
local depth  = in_column(1 - radius + billows * (lumps - 0.5))

-- Towards its end the smoke thins out, and its edges grow soft. Where the column cannot reach, the
-- first factor is 0, and no noise is computed.
local near  = 1 - smoothstep(1.6, 1.9, in_column(radius))
local young = smoothstep(height, 0.4 * height, z)
local smoke = near * smoothstep(0, mix(0.45, 0.12, young), depth - 0.5 * (1 - young)) * step(5.5, position.z) * (0.2 + 0.8 * young)

-- Computed once a voxel; the smallest eddies are finer than these voxels and torn in while marching.
local box   = { min = {-3.5, -5, 5.5}, max = {16, 7, 20.5} }
local whole = bake(smoke, { size = {160, 96, 120}, box = box })
local eddies = curl { frequency = 1.3, octaves = 3, persistence = 0.6, seed = 9, drift = {0, 0, -2.2}, speed = 0.6 }:tile()

fx.camera = camera { eye = {5.5, -25, 1.7}, target = {5.5, 0, 9.2}, fov = 46, near = 0.1, far = 800 }
fx.sun    = sun { azimuth = 205, elevation = 38, color = {1, 0.94, 0.86}, strength = 5 }
fx.sky    = sky { zenith = {0.10, 0.24, 0.58}, horizon = {0.50, 0.60, 0.72}, strength = 0.8 }

local lit    = lighting { density = whole:warp(eddies, ragged) * density, albedo = {0.97, 0.97, 0.97}, anisotropy = 0.3 }
local scene  = geometry { mesh { "data/ground.obj" }, mesh { "data/stack.obj" } }
local solid  = shade { from = {scene, lit}, haze = 0.003 }
local volume = march { from = {lit, scene}, steps = 160 }

local picture = over { volume, solid, from = {volume, scene} }
local shown   = final { source = picture, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
