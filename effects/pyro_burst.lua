-- A petrol bomb: a mist of burning petrol is thrown up from the ground, rolls, mushrooms, and leaves
-- black smoke with fire inside. Nothing is played back: fuel burns where it is hot and finds air, what
-- burns expands and rises, and soot glows until it has cooled.
--
--   roil render effects/pyro_burst.lua --frames 24 -o burst.png
--   roil render effects/pyro_burst.lua --frames 24 --set quality=film -o film.png    -- on a graphics card

local fx = effect { name = "pyro burst", fps = 24, frames = 96, author = "the roil authors", licence = "MIT" }

local quality = param { "quality", "draft", words = {"draft", "shot", "film"}, help = "how fine its cells are" }
local fuel    = param { "fuel", 0.13, min = 0, max = 5, unit = "kg/m^3", help = "of the mist; air burns 0.08, and what is more burns black" }
local smoke   = param { "smoke", 8700, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of soot hides; that of a real fire is 8700" }
local dust    = param { "dust", 0.012, min = 0, max = 0.1, unit = "kg/m^3", help = "of the layer that is torn from the ground" }
local haze    = param { "haze", 870, min = 0, max = 20000, unit = "m^2/kg", help = "what 1 kg of dust hides" }
local charge  = param { "charge", 0.25, min = 0.001, max = 10, unit = "kg", help = "TNT that bursts the bottle: it throws debris and tears up dust" }
local guided  = param { "guided", false, help = "whether shot and film have the large eddies of the draft, which runs beside them" }
local glow    = param { "glow", 3, min = 0, max = 50, help = "factor of the fire's light" }

-- The mist when it is lit: rich in the middle of each lump, poor between them, and whirling.
local lumps = worley { frequency = 1.3, octaves = 3, seed = 3 }:remap(0.1, 0.7, 0, 1)
local whirl = curl { frequency = 0.8, octaves = 3, seed = 5 }

-- The blast does more the nearer it is: its impulse tears dust from the ground, a thin layer that flies
-- outwards, and throws debris.
local burst = blast { position = {0, 0, 0.8}, charge = charge }
local outwards = position * vec(1, 1, 0)
local torn = smoothstep(18, 45, burst.impulse)
local way = position - vec(0, 0, 0.3)
local debris = particles {
  count = 14, burst = 14, lifetime = {0.6, 1.5}, seed = 11, position = {0, 0, 0.9}, radius = 0.5,
  speed = way / max(length(way), 0.1) * burst.impulse * 0.15, variation = 0.5,
  gravity = 9.81, drag = 0.2, collide = position.z, clearance = 0.05, bounce = 0.3, friction = 0.6,
}

-- A box of 9 x 9 x 12.6 m. Two cores bear the draft, a graphics card the film.
local sizes = { draft = {80, 80, 112}, shot = {160, 160, 224}, film = {224, 224, 320} }
local speeds = { draft = 20, shot = 14, film = 10 } -- the finer the cells, the more of them gas may cross in a step
local function burn(cells, speed, guide)
  local fire = pyro {
    size = cells, voxel_size = 9 / cells[1], fuel = "petrol", speed = speed, velocity_cells = "half", density = "variable",
    burn_time = 0.03, cooling = 2200, soot_burn_time = 2, vorticity = 6, guide = guide,
  }
  fire:source {
    shape = sphere { position = {0, 0, 1}, radius = 1.15 },
    fuel = fuel * (0.2 + 1.6 * lumps), temperature = 900,
    velocity = whirl * 6 + vec(0, 0, 5), during = {0, 0.02},
  }
  fire:source {
    shape = box { position = {0, 0, 0.15}, size = {8, 8, 0.3} } * step(0.01, torn),
    smoke = dust * lumps * torn, during = {0.03, 0.1},
    velocity = (outwards / max(length(outwards), 0.2) * 0.13 + vec(0, 0, 0.06)) * burst.impulse * torn,
  }
  -- Debris burns as it flies, and drags fire and smoke behind it until it has cooled.
  local heat = 1 - particle_age
  fire:source {
    particles = debris, shape = box { position = {0, 0, 3.5}, size = {9, 9, 7} }, -- no cells above are asked
    radius = 0.1 * heat * smoothstep(4.3, 3, length(outwards)), rate = 80, velocity_factor = 0.2,
    fuel = 0.06 * heat, temperature = 500 + 900 * heat, soot = 0.0003 * heat,
  }
  return fire
end
local draft = guided:get() and quality:get() ~= "draft" and burn(sizes.draft, speeds.draft)
local fire = burn(sizes[quality:get()], speeds[quality:get()], draft and draft.velocity or nil)

fx.camera = orbit { target = {0, 0, 4}, distance = 18, yaw = 25, pitch = 4, fov = 38 }
fx.sun    = sun { azimuth = 215, elevation = 30, color = {1, 0.92, 0.8}, strength = 6 }
fx.sky    = sky { zenith = {0.08, 0.16, 0.36}, horizon = {0.34, 0.42, 0.52}, strength = 0.7 }

-- What is finer than a cell: lumps that the gas carries along, hotter and colder than it is as a whole.
local ripple = worley { frequency = 1.8, octaves = 3, persistence = 0.6, seed = 8 }
               :tile():advect(fire.velocity, { period = 0.5, mean = 0.48 })
local kelvin = fire.temperature * (0.82 + 0.42 * ripple)

-- What absorbs light gives it off, too: soot by its temperature, and the flame itself a little.
local light = palette { blackbody = {500, 4500}, physical = true, reference = 1500 }
local flame = smoothstep(1000, 1500, kelvin)
local burns = (fire.soot * smoke + flame * 1.5) * (0.4 + 1.2 * ripple)
local flies = fire.smoke * haze * (0.4 + 1.2 * ripple) -- dust
local cover = burns + flies
local lit = lighting {
  density    = cover,
  emission   = light(kelvin) * burns * flame * glow,
  albedo     = 0.75,
  tint       = mix(vec(0.4, 0.4, 0.4), vec(0.95, 0.8, 0.63), flies / max(cover, 0.001)),
  anisotropy = 0.3,
  sampling   = "cubic",
}

-- Burning drops fly off, fall, bounce and go out.
local drops = particles {
  count = 700, rate = function(t) return t < 0.06 and 12000 or 0 end, lifetime = {0.5, 2.2}, seed = 6,
  position = {0, 0, 1}, radius = 0.7, speed = {0, 0, 11}, spread = 85, variation = 0.8,
  gravity = 9.81, drag = 0.7, collide = position.z, bounce = 0.3, friction = 0.5,
}

-- Sparks come off where it burns, and go where the gas goes.
local embers = particles {
  count = 3000, rate = curve { {0.05, 0}, {0.1, 3000}, {0.8, 1500}, {1.3, 0} }, lifetime = {0.3, 1.1}, seed = 2,
  above = {fire.burn * box { position = {0, 0, 2.5}, size = {5, 5, 5} }, 0.5},
  velocity = fire.velocity, inherit = 1, gravity = 3, drag = 5,
}

-- The ground is burnt where fire lay on it.
local scene  = geometry { mesh { "data/ground.obj" } }
local burnt  = smoothstep(2.2, 0.5, length(outwards) + 0.9 * lumps) * curve { {0.05, 0}, {0.6, 1} }
local colors = shader { "burnt_ground.comp", albedo = scene.albedo, depth = scene.depth, burnt = burnt, lift = 0 }
local chunks = pieces {
  debris, mesh { "data/shard.obj" }, scene_albedo = colors.color, from = scene,
  size = 0.25 + 0.3 * particle_random, angle = 900 * (particle_random - 0.5) * particle_age,
}
local solid  = shade { from = {chunks, scene, lit}, haze = 0.002 }
local volume = march { from = {lit, chunks}, steps = 192, jitter = 0.5 }

local sparks = splats {
  from = {drops, scene, lit}, density = cover, size = over_age { {0, 0.02}, {1, 0.006} }, streak = 0.03,
  color = light(1900 - 700 * particle_age).rgb, brightness = 12,
}
local glowing = splats {
  from = {embers, chunks, lit}, density = cover, size = over_age { {0, 0.016}, {1, 0.006} }, streak = 0.02,
  color = light(2000 - 800 * particle_age).rgb, brightness = 8,
}
local picture = over { sparks, over { volume, solid, from = {volume, chunks} }, from = {sparks, chunks} }
picture = over { glowing, picture, from = {glowing, chunks} }
local blooms  = bloom { bright { picture, threshold = 1.0 }, radius = 0.7 }
local shown   = final { source = picture, bloom = blooms, bloom_intensity = 0.3, tonemap = "aces" }

fx.output = shown.color
fx.linear = shown.linear
fx.depth  = chunks.depth
return fx
