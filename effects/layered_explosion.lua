-- The layered explosion (Avalos 2019): no smoke is simulated and nothing is played back. A ball whose
-- surface is pushed out by two layers of noise, coloured by how far it was pushed and how old it is;
-- it dissolves into a globe of smoke that is bright at no rim; a light that flares up and dies; the
-- exposure of the whole picture goes from 0.6 to 1 and back, or what 1 lacks is subtracted from it.
-- Every number of it stands in the panel.
--
--   roil render effects/layered_explosion.lua --frames 14 -o explosion.png
--   roil render effects/layered_explosion.lua --frames 14 --set form=mesh -o mesh.png
--   roil render effects/layered_explosion.lua --frames 14 --set form=volume -o volume.png
--   roil render effects/layered_explosion.lua --frames 14 --set flash_by=subtraction -o subtracted.png
--   roil live effects/layered_explosion.lua     -- click on the ground, press x, or throw a bomb with b
--
-- One picture, three ways to it. rays: the surface is found by a ray for each pixel. mesh: as
-- published, the vertices of a sphere are moved and drawn. volume: the same layers fill space, and a
-- ray marches through what is inside of the surface.

local fx = effect { name = "layered_explosion", fps = 24, frames = 120, author = "the roil authors", licence = "MIT" }

local form = param { "form", "rays", words = {"rays", "mesh", "volume"}, help = "what the explosion is made of" }

-- The ball.
local size      = param { "size", 1.75, min = 0.1, max = 10, unit = "m", help = "radius of the ball when it has grown" }
local life      = param { "life", 1.75, min = 0.2, max = 10, unit = "s", help = "from the burst until the last of the ball is gone" }
local growth    = param { "growth", 11, min = 1, max = 40, help = "how fast it grows: a blast is at its size in a few frames" }
local swelling  = param { "swelling", 0.35, min = 0, max = 2, help = "by which it goes on growing, of its size" }
local rise      = param { "rise", 1.5, min = 0, max = 6, unit = "m", help = "how far it is carried up" }

-- The layers: {scale, strength} of each. One alone is too soft.
local noise     = param { "noise", "billow", words = {"published", "perlin", "billow", "worley"}, help = "what layers are made of; published: a picture wrapped around the ball" }
local scale1    = param { "scale1", 1.35, min = 0.2, max = 20, help = "lumps of the first layer across the ball" }
local strength1 = param { "strength1", 1, min = 0, max = 4, help = "what the first layer counts for" }
local scale2    = param { "scale2", 4.1, min = 0.2, max = 40, help = "of the second" }
local strength2 = param { "strength2", 0.5, min = 0, max = 4, help = "of the second" }
local extrusion = param { "extrusion", 0.85, min = 0, max = 2, help = "how far the highest lump is pushed out, of the radius" }
local boil      = param { "boil", 0.5, min = 0, max = 4, unit = "1/s", help = "how fast the lumps turn into others" }

-- The colours: where in the gradient a point is, and when it has gone through.
local spread    = param { "spread", 1.15, min = 0, max = 3, help = "part of the gradient between the deepest and the highest point" }
local depth0    = param { "depth0", -0.3, min = -2, max = 2, help = "what is added to that at the burst" }
local depth1    = param { "depth1", 1.12, min = -2, max = 3, help = "and at the end: colours advance, and darken" }
local dissolve  = param { "dissolve", 1.1, min = 0.3, max = 3, help = "depth at which nothing is left of it" }
local tear      = param { "tear", 0.85, min = 0, max = 3, help = "how much sooner the first hole opens" }
local ember     = param { "ember", 1.6, min = 0, max = 50, help = "glow of the edges that are burnt through" }
local brightness = param { "brightness", 1.0, min = 0, max = 20, help = "factor of the fire's light" }

-- The smoke.
local smoke_at     = param { "smoke_at", 0.2, min = 0, max = 5, unit = "s", help = "after the burst, when its globe begins" }
local smoke_life   = param { "smoke_life", 3.2, min = 0.1, max = 20, unit = "s", help = "how long it is seen" }
local smoke_size   = param { "smoke_size", 0.8, min = 0, max = 5, help = "of its globe at first, of the ball's size" }
local smoke_growth = param { "smoke_growth", 1.15, min = 0, max = 5, help = "by which it grows" }
local smoke_alpha  = param { "smoke_alpha", 2.2, min = 0, max = 3, help = "opacity at first" }
local smoke_noise  = param { "smoke_noise", 1.5, min = 0, max = 3, help = "part of the opacity that is noise" }

local dust         = param { "dust", 0.5, min = 0, max = 2, help = "opacity of the dust that is driven along the ground" }
local dust_reach   = param { "dust_reach", 2.4, min = 0, max = 10, help = "how far it gets, of the ball's size" }

-- The light and the flash.
local light_at    = param { "light_at", 0.04, min = 0, max = 2, unit = "s", help = "after the burst, when it begins" }
local light_grow  = param { "light_grow", 0.12, min = 0.01, max = 2, unit = "s", help = "until it is brightest" }
local light_fade  = param { "light_fade", 0.75, min = 0.05, max = 5, unit = "s", help = "until it is dark again" }
local light_power = param { "light_power", 9000, min = 0, max = 100000, unit = "W", help = "when it is brightest" }
local light_color = param { "light_color", "#ffa24a", help = "colour of the light" }
local flash_by    = param { "flash_by", "exposure", words = {"exposure", "subtraction"}, help = "what makes the picture darker than the flash: a factor on its light, or an amount taken from what is shown" }
local flash_low   = param { "flash_low", 0.6, min = 0.05, max = 2, help = "exposure of the picture" }
local flash_high  = param { "flash_high", 1.0, min = 0.05, max = 4, help = "exposure when it bursts" }
local flash_time  = param { "flash_time", 0.7, min = 0.05, max = 5, unit = "s", help = "there and back" }

-- Where and when: seconds, place, size. More come from the keyboard, from the mouse, and from a bomb that
-- bursts where it hits something: timer, script and collision.
local blasts = explosions {
  { 0.25, position = {0, 0, 0.9}, size = 1, seed = 3 },
  { 0.80, position = {3.1, 1.6, 0.5}, size = 0.55, seed = 9 },
  { 1.05, position = {-2.9, 0.9, 0.45}, size = 0.5, seed = 21 },
}
fx:on_key("x", function() blasts:add { position = {0, 0, 0.9}, size = 1 } end, "another explosion in the middle")
fx:on_click(function(event)
  local at = event.hit and event.hit.position
  if at then blasts:add { position = {at[1], at[2], at[3] + 0.5}, size = 0.7 } end
end, "an explosion there")

local bomb = nil -- its place and velocity while it flies
fx:on_start(function() bomb = nil end)
fx:on_key("b", function() bomb = { {-11, -4, 0.6}, {4.7, 5.45, 6.2} } end, "throw a bomb at the crates")
fx:on_frame(function(_, dt)
  if not bomb then return end
  local p, v = bomb[1], bomb[2]
  local hit = pick { p, v }
  local far = dt * math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
  if hit and hit.distance <= far then
    blasts:add { position = {hit.position[1], hit.position[2], hit.position[3] + 0.4}, size = 0.75 }
    bomb = nil
    return
  end
  for i = 1, 3 do p[i] = p[i] + dt * v[i] end
  v[3] = v[3] - 9.81 * dt
end)
fx.events = { { 1.3, key = "b" } }

-- N keys at equal distances; the palette editor changes them.
local fire = palette {
  {0.0, {9, 6.5, 3}}, {0.2, {6, 2.3, 0.35}}, {0.4, {2.8, 0.62, 0.05}}, {0.6, {0.75, 0.085, 0.012}},
  {0.8, {0.05, 0.014, 0.010}}, {1.0, {0.008, 0.007, 0.007}},
}

-- low and high: between which most of it lies.
local kinds = {
  published = { dimensions = 2, cells = 3, low = 0.35, high = 0.95 }, -- scales count lumps all around, not across
  perlin = { low = 0.35, high = 0.95 },
  billow = { fractal = "billow", low = 0, high = 1 },
  worley = { noise = worley, low = 0.3, high = 1.1 },
}
local function lumps_of(shift)
  local kind = kinds[noise:get()]
  local cells = kind.cells or 1
  return layers {
    {scale1 * cells, strength1}, {scale2 * cells, strength2},
    noise = kind.noise, fractal = kind.fractal, dimensions = kind.dimensions, speed = boil, seed = 5, shift = shift,
  }:remap(kind.low, kind.high, 0, 1)
end
local function holes_of(shift)
  return layers { {1.7, 1}, {5.5, 0.6}, seed = 70, shift = shift }:remap(0.2, 0.8, 0, 1)
end
local function wisps_of(shift)
  return layers { {1.4, 1}, {3.9, 0.55}, {9.5, 0.25}, fractal = "billow", speed = 0.25, seed = 40, shift = shift }:remap(0.05, 0.55, 0, 1)
end

-- What the ball and the smoke are at an age (0..1), whatever they are made of.
local function ball_radius(age) return size * (1 - exp(-growth * age) + swelling * age) end
local function ball_height(age) return rise * age * (2 - age) end
local function depth_of(age) return mix(depth0, depth1, age ^ 0.8) end
local function gradient_at(lumps, depth) return lumps * spread + depth end
local whole = smoke_at + smoke_life
local function smoke_age(age) return clamp((age * whole - smoke_at) / smoke_life, 0, 1) end
local function smoke_radius(age) return size * (smoke_size + smoke_growth * sqrt(age)) * step(0.0001, age) end

fx.camera = camera { eye = {0, -11.5, 1.7}, target = {0, 0, 2.2}, fov = 40, near = 0.1, far = 500 }
fx.sun    = sun { azimuth = 198, elevation = 14, color = {1, 0.66, 0.42}, strength = 2 }
fx.sky    = sky { zenith = {0.012, 0.026, 0.075}, horizon = {0.15, 0.085, 0.08}, night = 0.35, stars = 1.2, strength = 1 }

-- Of a list of explosions those that have begun last have the lights.
local function since(t, which)
  local one = blasts:latest(t, which)
  return one, one and t - one.time
end
local function light(which)
  return point_light {
    position = function(t)
      local one, age = since(t, which)
      if not one then return {0, 0, 1} end
      local p, part = one.position, math.min(age / life:get(), 1)
      return {p[1], p[2], p[3] + one.size * rise:get() * part * (2 - part) + 0.3}
    end,
    color = light_color,
    power = function(t)
      local one, age = since(t, which)
      local up = one and (age - light_at:get()) / light_grow:get() or -1
      if up <= 0 then return 0 end
      local down = math.max(1 - (age - light_at:get() - light_grow:get()) / light_fade:get(), 0)
      return light_power:get() * one.size ^ 2 * (up < 1 and up or math.min(down, 1) ^ 2)
    end,
  }
end
fx.lights = { light(1), light(2), light(3) }

local function exposure(t)
  local most = 0
  for which = 1, 3 do
    local one, age = since(t, which)
    if one and age < flash_time:get() then most = math.max(most, one.size * math.sin(math.pi * age / flash_time:get())) end
  end
  return flash_low:get() + (flash_high:get() - flash_low:get()) * math.min(most, 1)
end

-- A clearing: what stands around is what tells how large a blast is, and where its light comes from.
local function far_from(x, y) return length(vec(position.x - x, position.y - y, 0)) end
local woods = instances {
  mesh { "data/pine.obj" }, mesh { "data/leafy.obj" },
  at = scatter { count = 130, size = {64, 44}, position = {0, 13, 0}, distance = 2.1, seed = 4, inside = far_from(0, -4) - 13 },
  kind = {0.85, 0.15}, scale = {0.75, 1.5}, yaw = {0, 360}, color = {0.8, 0.85, 0.9}, seed = 4,
}
local undergrowth = instances {
  mesh { "data/tuft.obj" }, mesh { "data/fern.obj" }, mesh { "data/rock.obj" }, mesh { "data/stump.obj" },
  at = scatter { count = 240, size = {34, 24}, position = {0, 1, 0}, distance = 0.8, seed = 7, inside = min(min(far_from(0, 0.6) - 4, far_from(0, -5) - 3.4), far_from(-6.8, 0.6) - 1.6) },
  kind = {0.55, 0.25, 0.16, 0.04}, scale = {0.5, 1.2}, yaw = {0, 360}, seed = 3,
}
local ground = mesh { "data/ground.obj", color = {0.55, 0.5, 0.45}, material = material { specular = 0.35, roughness = 0.5 } }
local scene  = geometry { ground, mesh { "data/crates.obj", position = {-7.4, 0.6, 0} }, woods, undergrowth }

-- As shells: fields are asked at the unit sphere, and told of the shell that they are asked for.
local function as_shells()
  local of_form, lumps = form:get(), lumps_of()
  local at = gradient_at(shell_displacement / extrusion, shell_depth)
  local holes = holes_of()
  local left = dissolve - shell_depth - tear * holes
  local facing = dot(shell_view, shell_normal)
  local ball = shell {
    name = "ball", at = blasts, from = scene, mode = of_form, life = life,
    radius = ball_radius(shell_age), position = vec(0, 0, ball_height(shell_age)),
    displacement = extrusion * lumps, shell_depth = depth_of(shell_age), clip = left,
    color = (fire(at).rgb * (0.55 + 0.45 * facing) + vec(1, 0.22, 0.03) * ember * smoothstep(0.045, 0, left) * smoothstep(1, 0.5, shell_age)) * brightness,
    albedo = 0.09 * smoothstep(0.55, 0.85, at),
    opacity = smoothstep(0, 0.03, left), soften = 0.12,
  }
  local age = smoke_age(shell_age)
  local rim = saturate(dot(shell_view, shell_normal))
  local wisps = wisps_of()
  local globe = shell {
    name = "smoke", resolution = 0.5, at = blasts, depth = ball.front, mode = of_form, sides = "front", life = whole,
    radius = smoke_radius(age), position = vec(0, 0, ball_height(clamp(shell_age * whole / life, 0, 1)) + 0.8 * age),
    displacement = 0.33 * wisps * (0.8 + 0.4 * position.z),
    opacity = smoothstep(0, 1, rim) * (smoke_alpha + smoke_noise * (wisps - 0.5) - (smoke_alpha + 0.5 * smoke_noise) * age) * smoothstep(0, 0.1, age),
    albedo = vec(0.66, 0.58, 0.53) * (0.25 + 0.75 * wisps), color = vec(1, 0.25, 0.04) * (0.35 * exp(-6 * age) * (1 - wisps)),
    wrap = 0.35, soften = 0.7,
  }
  -- Dust that the blast drives along the ground: the same sphere, as flat as a cake.
  local flat = 1 / sqrt(1 + 34 * position.z * position.z)
  local puffs = wisps:warp(position * (2 * flat - 1))
  local skirt = shell {
    name = "skirt", resolution = 0.5, at = blasts, depth = ball.front, mode = of_form, sides = "front", life = 1.5,
    radius = size * (0.5 + dust_reach * (1 - exp(-3.2 * shell_age))), position = vec(0, 0, -0.55),
    displacement = flat * (1 + 0.5 * puffs) - 1,
    opacity = dust * smoothstep(0, 0.9, rim) * (1.6 * puffs + 0.2 - 1.2 * shell_age),
    albedo = vec(0.62, 0.50, 0.40) * (0.5 + 0.5 * puffs), wrap = 0.6, soften = 0.8,
  }
  -- The bomb: a shell that nothing pushes out.
  local flying = shell {
    name = "bomb", from = scene, life = 1e6, color = {9, 3.2, 0.7},
    radius = function() return bomb and 0.09 or 0 end, position = function() return bomb and bomb[1] or {0, 0, -1} end,
  }
  return over { globe, over { skirt, over { ball, over { flying, shade { from = scene, haze = 0.006 } } } } }
end

-- As a volume: the same fields, asked at the direction of each point in space from the centre. What is
-- inside of the surface burns, the deeper the hotter; smoke fills the globe. The layers of each explosion
-- are computed for all of the box, so that only those of the list can be drawn.
local function volume_of(one)
  local at = one.position
  local begun = step(one.time, time)
  local function space(of, radius, height) -- a field of directions, and how deep a point is, in radii
    local p = (position - vec(at[1], at[2], at[3] + height)) / (one.size * radius)
    local far = max(length(p), 0.001)
    return of:warp(p / far - position), far
  end
  local age = (time - one.time) / (life * one.life)
  local now = clamp(age, 0, 1)
  local radius, depth = ball_radius(now), depth_of(now)
  local lumps, far = space(lumps_of(one.shift), radius, ball_height(now))
  local holes = space(holes_of(one.shift), radius, ball_height(now))
  local inside = 1 + extrusion * lumps - far
  local colour = gradient_at(lumps, depth)
  local left = dissolve - depth - tear * holes
  local reach = sphere { position = vec(at[1], at[2], at[3] + ball_height(now)), radius = one.size * radius * (1 + extrusion), falloff = 0 }
  local ball = reach * smoothstep(0, 0.12, inside) * smoothstep(0, 0.15, left) * begun * step(age, 1)

  local whole_age = (time - one.time) / (whole * one.life)
  local old = smoke_age(whole_age)
  local height = ball_height(clamp(age, 0, 1)) + 0.8 * old
  local wisps, out = space(wisps_of(one.shift), smoke_radius(old), height)
  local around = sphere { position = vec(at[1], at[2], at[3] + height), radius = one.size * smoke_radius(old) * 1.4 }
  local alpha = saturate(smoke_alpha + smoke_noise * (wisps - 0.5) - (smoke_alpha + 0.5 * smoke_noise) * old) * smoothstep(0, 0.1, old)
  local globe = around * smoothstep(0, 0.25, 1 + 0.33 * wisps - out) * alpha * begun
  return ball * 9 + globe * 1.6, fire(colour).rgb * ball * (9 * brightness)
end

local function as_volume()
  local density, emission = 0, vec(0, 0, 0)
  for i = 1, #blasts do
    local thick, shining = volume_of(blasts:get(i))
    density, emission = density + thick, emission + shining
  end
  local lit = lighting { density = density, emission = emission, albedo = {0.5, 0.45, 0.42}, anisotropy = 0.1 }
  local solid = shade { from = {scene, lit}, haze = 0.006 }
  local smoke = march { from = {lit, scene}, steps = 96, jitter = 0.5, resolution = 0.5 }
  return over { smoke, solid, from = {smoke, scene} }
end

local picture = form:get() == "volume" and as_volume() or as_shells()
local glow    = bloom { bright { picture, threshold = 1.2 }, radius = 0.75 }
local shown   = final {
  source = picture, bloom = glow, bloom_intensity = 0.3, tonemap = "agx", saturation = 1.25,
  exposure_ev = flash_by:get() == "exposure" and function(t) return math.log(exposure(t), 2) end or 0,
  subtract    = flash_by:get() == "subtraction" and function(t) return math.max(1 - exposure(t), 0) end or 0,
}

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = scene.depth
return fx
