-- The grid of Raseta, Lesar and Bohak, "Real-time volumetric explosion special effects for games"
-- (2025), section 4.1: steps, resolution of the march, noise. Their data, their view, their opacity.
--
--   roil bench scripts/bench/paper.lua -o out/paper
--   roil bench scripts/bench/paper.lua -o out/paper --size 480x270 --frames 30       -- small

-- Tables 1 to 3: milliseconds of the whole frame on three cards, by steps, resolution and noise.
local cards = { "GTX 1650", "GTX 1050 Ti", "RTX 4000 Ada" }
local published = {
  ["16 0.25 perlin"]       = {7.21, 3.54, 1.77},
  ["32 0.25 perlin"]       = {9.37, 5.11, 3.41},
  ["32 0.5 perlin"]        = {33.64, 11.19, 8.32},
  ["64 0.25 worley_curl"]  = {83.85, 34.54, 10.56},
  ["64 0.5 worley_curl"]   = {320.51, 127.27, 10.68},
  ["128 0.25 perlin"]      = {38.52, 12.78, 9.24},
  ["128 0.25 worley_curl"] = {180.47, 68.88, 9.50},
  ["128 0.5 perlin"]       = {142.50, 48.23, 12.78},
  ["128 0.5 worley_curl"]  = {675.69, 252.12, 21.17},
  ["256 1 worley_curl"]    = {5412.35, 1867.12, 159.30},
}

return sweep {
  name = "paper", title = "The published grid: steps, resolution, noise",
  notes = {
    "Published: whole frames in WebGPU on GTX 1650, GTX 1050 Ti and RTX 4000 Ada (tables 1 to 3).",
    "Error is against 1024 steps at full resolution with the same noise, evaluated at every sample.",
  },
  effect = "../../effects/paper.lua", size = {1920, 1080}, frames = "28-34", warmup = 8, limit = 120,
  set = { opacity = 20, ["camera.eye"] = {-7.84, 4, 1.79}, ["camera.target"] = {4, 4, 0}, ["camera.fov"] = 57.3 },
  axes = {
    axis { "steps", 16, 32, 64, 128, 256 },
    axis { "march.resolution", 0.25, 0.5, 1, label = "resolution" },
    axis { "noise", "perlin", "worley", "worley_curl" },
    axis { "noise_bake", "exact", "tile" },
  },
  reference = { steps = 1024, resolution = 1, noise_bake = "exact" },
  published = function(row)
    local times, figures = published[string.format("%d %g %s", row.steps, row.resolution, row.noise)], {}
    for i, card in ipairs(cards) do figures[card] = times and times[i] end
    return figures
  end,
}
