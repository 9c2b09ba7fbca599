-- A row of barrels in a freight yard. The first is lit; each burns until it bursts, and what it bursts
-- lights those within reach, up to the heap at the end. Who lights whom is the rule module `spread`, the
-- one that forest_fire burns down a wood with: here fire is passed on when something is over, not when
-- it begins.
--
--   roil render effects/barrel_chain.lua -o chain.mp4
--   roil live effects/barrel_chain.lua        -- click on a barrel, or press f for the first of the row
--   roil render effects/barrel_chain.lua --frames 130 --event "0.2 click 0.8 0.55" -o other_end.png
--
-- Everything else follows from two numbers of each barrel, when it was lit and when it burst: flames, the
-- light of both, pieces of its wall that fly, a mark on the ground. The burst itself is a layered
-- explosion, as layered_explosion.lua explains.

local spread = require "spread"
local fx = effect { name = "barrel_chain", fps = 24, frames = 216, author = "the roil authors", licence = "MIT" }

local reach     = param { "reach", 1.5, min = 0.2, max = 6, unit = "m", help = "how far a burst lights others" }
local size      = param { "size", 1.05, min = 0.1, max = 5, unit = "m", help = "radius of a burst" }
local life      = param { "life", 1.25, min = 0.2, max = 6, unit = "s", help = "of its ball of fire" }
local growth    = param { "growth", 11, min = 1, max = 40, help = "how fast it grows" }
local rise      = param { "rise", 1.1, min = 0, max = 6, unit = "m", help = "how far it is carried up" }
local extrusion = param { "extrusion", 0.9, min = 0, max = 2, help = "how far lumps are pushed out, of the radius" }
local smoke     = param { "smoke", 2.2, min = 0, max = 4, help = "opacity of the smoke at first; it is limited to 1" }
local flare     = param { "flare", 5200, min = 0, max = 50000, unit = "W", help = "light of a burst when it is brightest" }
local burning   = param { "burning", 160, min = 0, max = 5000, unit = "W", help = "light of a barrel that burns" }
local pieces_of = param { "pieces", 26, min = 0, max = 100, help = "pieces that fly from a barrel" }
local speed     = param { "speed", 8.5, min = 0, max = 30, unit = "m/s", help = "of the fastest" }
local flash_low  = param { "flash_low", 0.6, min = 0.05, max = 2, help = "exposure of the picture" }
local flash_high = param { "flash_high", 1.0, min = 0.05, max = 4, help = "exposure when something bursts" }

-- ---- the barrels ------------------------------------------------------------------------------------

-- A row that winds through the yard, and at its end a heap, the upper ones on the lower.
local places = {}
for i = 0, 12 do
  local u = i / 12
  places[#places + 1] = { -1.1 + 8.3 * u + 0.12 * math.sin(31 * i), 1.6 + 2.3 * math.sin(5.6 * u + 0.4) + 0.1 * math.sin(17 * i), 0 }
end
local heap = { 7.55, 1.2 }
for k = 0, 2 do
  for i = 0, 2 - k do
    places[#places + 1] = { heap[1] - 0.65 + 0.66 * i + 0.33 * k, heap[2] + 0.9 + 0.05 * math.sin(9 * (i + k)), 0.885 * k }
  end
end

local NEVER = 1e6
local barrels = instances {
  mesh { "data/barrel.obj" }, mesh { "data/scorch.obj" },
  at = places, kind = 1, yaw = {0, 360}, scale = {0.97, 1.03}, seed = 6, state = {NEVER, NEVER, 0, 0},
}
local blasts = explosions {}
local fire = spread { fx = fx, at = barrels, reach = reach:get(), speed = 9, variation = 0.5, burn = {0.16, 0.42}, pass = "burned", late = 0, seed = 2 }

fire:on_ignite(function(i, t) barrels:set(i, { state = {t} }) end)
fire:on_burned(function(i, t)
  local one = barrels:get(i)
  local x, y, z = one.position[1], one.position[2], one.position[3]
  blasts:add { t, position = {x, y, z + 0.55}, size = 0.85 + 0.5 * one.random, seed = i }
  barrels:set(i, { kind = 2, position = {x, y, 0.0003 * i}, scale = 1.1 + 0.6 * one.random, state = {one.state[1], t, z} })
end)
fx:on_key("f", function() fire:ignite(1) end, "light the first of the row")
fx:on_click(function(event) if event.hit then fire:ignite_near(event.hit.position, 1) end end, "light the barrel there")
fx:on_frame(function()
  fx:status("burning", fire.burning)
  fx:status("burst", fire.burned)
end)
fx.events = { { 0.2, key = "f" } }

-- Of one of them: seconds since it was lit, and since it burst; below 0: not yet.
local lit_for, burst_for = time - instance_state.x, time - instance_state.y
local is_lit = step(0, lit_for) * step(burst_for, 0)
local puddle = step(0, burst_for) * smoothstep(5, 1, burst_for) -- what it has spilt burns on

-- ---- the yard ---------------------------------------------------------------------------------------

fx.camera = camera { eye = {3.2, -9.4, 2.2}, target = {3.4, 4, 1.5}, fov = 38, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 300, elevation = 24, color = {0.62, 0.75, 1}, strength = 0.55 }
fx.sky    = sky { zenith = {0.012, 0.024, 0.070}, horizon = {0.10, 0.065, 0.07}, night = 0.4, stars = 1.2 }

local lamps = point_lights {
  at = barrels, position = vec(0, 0, 1.1), color = {1, 0.52, 0.17}, radius = 0.3, range = 15,
  power = burning * (0.75 + 0.25 * sin(41 * time + 60 * instance_random)) * (is_lit + 0.7 * puddle)
        + flare * smoothstep(0, 0.09, burst_for) * smoothstep(0.85, 0.05, burst_for),
}
-- Strips of its wall fly from a barrel, and its lid. Both fall as stones do; the lid goes up before all else.
local function debris(settings)
  local all = {
    at = barrels, share = step(0, burst_for) * step(burst_for, 0.04), lifetime = {2.5, 5}, seed = 3,
    position = {0, 0, 0.5}, radius = 0.3, outward = speed * 0.5, speed = vec(0, 0, 1) * speed, spread = 62, variation = 0.75,
    gravity = 9.81, drag = 0.12, collide = position.z, clearance = 0.05, bounce = 0.32, friction = 0.45,
  }
  for key, value in pairs(settings) do all[key] = value end
  return particles(all)
end
local shards = debris { name = "shards", rate = pieces_of * 24, count = 2048 }
local lids   = debris { name = "lids", rate = 24, count = 32, lifetime = 6, position = {0, 0, 0.9}, radius = 0.05, outward = 0, spread = 25, variation = 0.3 }
local ground = mesh { "data/ground.obj", color = {0.6, 0.6, 0.65}, material = material { specular = 0.09, roughness = 0.42 } } -- damp
local scene = geometry { ground, mesh { "data/yard.obj" }, barrels }
-- Few are large, and most are black with soot, so that paint is seen on some only. They tumble until they lie.
local paint  = (0.5 + 0.5 * sin(97 * particle_random)) ^ 5
local soot   = vec(0.3, 0.45, 0.5) + paint * vec(0.7, 0.45, 0.4)
local tumble = 1300 * (particle_random - 0.5) * over_age { {0, 0}, {0.35, 1}, {1, 1.1} }
local strips = pieces { shards, mesh { "data/scrap.obj" }, from = scene, size = 0.25 + 0.6 * particle_random ^ 4, color = soot, angle = tumble }
local drawn  = pieces { lids, mesh { "data/lid.obj" }, from = strips, color = soot, angle = tumble }
local solid = shade { from = {drawn, scene, lamps}, point_light_shadows = "rays", haze = 0.004 }

-- ---- the bursts -------------------------------------------------------------------------------------

local gradient = palette {
  {0.0, {9, 6.5, 3}}, {0.2, {6, 2.3, 0.35}}, {0.4, {2.8, 0.62, 0.05}}, {0.6, {0.75, 0.085, 0.012}},
  {0.8, {0.05, 0.014, 0.010}}, {1.0, {0.008, 0.007, 0.007}},
}
local function height_of(age) return rise * age * (2 - age) end
local lumps = layers { {1.35, 1}, {4.1, 0.5}, fractal = "billow", speed = 0.6, seed = 5 }
local holes = layers { {1.7, 1}, {5.5, 0.6}, seed = 70 }:remap(0.2, 0.8, 0, 1)
local at = shell_displacement / extrusion * 1.15 + shell_depth
local left = 1.1 - shell_depth - 0.85 * holes
local ball = shell {
  name = "ball", at = blasts, from = drawn, life = life,
  radius = size * (1 - exp(-growth * shell_age) + 0.35 * shell_age), position = vec(0, 0, height_of(shell_age)),
  displacement = extrusion * lumps, shell_depth = mix(-0.3, 1.12, shell_age ^ 0.8), clip = left,
  color = gradient(at).rgb * (0.55 + 0.45 * dot(shell_view, shell_normal)) + vec(1.3, 0.28, 0.04) * smoothstep(0.16, 0, left) * smoothstep(1, 0.5, shell_age),
  albedo = 0.09 * smoothstep(0.55, 0.85, at), opacity = smoothstep(0, 0.16, left), soften = 0.1,
}
local whole = 4.2 -- seconds that a globe of smoke is there, the first 0.15 of them behind the fire
local old = clamp((shell_age * whole - 0.15) / (whole - 0.15), 0, 1)
local wisps = layers { {1.4, 1}, {3.9, 0.55}, {9.5, 0.25}, fractal = "billow", speed = 0.25, seed = 40 }:remap(0.05, 0.55, 0, 1)
local globe = shell {
  name = "globe", resolution = 0.5, at = blasts, depth = ball.front, life = whole, sides = "front",
  radius = size * (0.8 + 1.1 * sqrt(old)), position = vec(0, 0, height_of(clamp(shell_age * whole / life, 0, 1)) + 1.1 * old),
  displacement = 0.33 * wisps * (0.8 + 0.4 * position.z),
  opacity = saturate(dot(shell_view, shell_normal)) * (smoke + 1.4 * (wisps - 0.5) - (smoke + 0.7) * old) * smoothstep(0, 0.06, old),
  albedo = vec(0.5, 0.46, 0.44) * (0.25 + 0.75 * wisps), color = vec(1, 0.25, 0.04) * (0.5 * exp(-7 * old) * (1 - wisps)),
  wrap = 0.35, soften = 0.5,
}

-- ---- flames and sparks ------------------------------------------------------------------------------

local air = vec(0.4, 0.1, 1.8) + 0.9 * curl { frequency = 0.9, octaves = 2, speed = 0.9 }
local flames = particles {
  at = barrels, share = is_lit + 0.7 * puddle, rate = 900, count = 65536, lifetime = {0.25, 0.65}, seed = 4,
  shape = disc { x = 0, y = 0, radius = 0.36 } * box { position = {0, 0, 0.35}, size = {1, 1, 0.7} }, velocity = air, motion = "carried",
}
local sparks = particles {
  at = barrels, share = step(0, burst_for) * step(burst_for, 0.05), rate = 3600, count = 16384, lifetime = {0.4, 1.6}, seed = 9,
  position = {0, 0, 0.6}, radius = 0.2, outward = 3, speed = {0, 0, 9}, spread = 85, variation = 0.8,
  gravity = 9.81, drag = 1.1, velocity = air, collide = position.z, clearance = 0.01, bounce = 0.3,
}
local flame_color = palette { {0, {2.2, 1.25, 0.45}}, {0.35, {1.7, 0.55, 0.09}}, {0.7, {0.8, 0.12, 0.012}}, {1, {0, 0, 0}} }
local hot = splats { from = {flames, drawn}, size = over_age { {0, 0.14}, {0.3, 0.22}, {1, 0.03} }, color = flame_color(particle_age).rgb, brightness = 0.9, streak = 0.16, soften = 0.1 }
local flying = splats { from = sparks, depth = ball.front, size = over_age { {0, 0.035}, {1, 0.012} }, color = flame_color(particle_age * 0.8).rgb, brightness = 5, streak = 0.022 }

local picture = over { globe, over { ball, over { hot, solid, from = {hot, drawn} } } }
picture = over { flying, picture, from = {flying, drawn} }

local function exposure(t)
  local most = 0
  for which = 1, 4 do
    local one = blasts:latest(t, which)
    local age = one and (t - one.time) / 0.5 or 1
    if age < 1 then most = math.max(most, one.size * math.sin(math.pi * age)) end
  end
  return math.log(flash_low:get() + (flash_high:get() - flash_low:get()) * math.min(most, 1), 2)
end
local glow  = bloom { bright { picture, threshold = 1.1 }, radius = 0.75 }
local shown = final { source = picture, bloom = glow, bloom_intensity = 0.35, exposure_ev = exposure, tonemap = "agx", saturation = 1.25 }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
