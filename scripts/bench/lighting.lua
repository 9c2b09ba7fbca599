-- What each approximation of light costs, and how far it is from the truth, which is path traced.
--
--   roil bench scripts/bench/lighting.lua -o out/lighting
--   roil bench scripts/bench/lighting.lua -o out/lighting --only 'scene=explosion 30' --size 320x180
--
-- A reference of 1024 samples a pixel takes seconds on a GPU and many minutes without one; it is
-- kept beside the results, and --resume finds it again.

return sweep {
  name = "lighting", title = "Parts of the light: cost and error",
  notes = {
    "Error is against 1024 paths a pixel, after tone mapping; haze is left out, and the march is at full resolution.",
    "Each row changes one thing of what the effect has by itself.",
  },
  size = {640, 360}, warmup = 4, repeats = 8, limit = 120,
  set = { ["march.resolution"] = 1, ["shade.haze"] = 0 },
  axes = {
    axis { "scene",
      { name = "explosion 10", effect = "../../effects/explosion.lua", frames = 10 },
      { name = "explosion 30", effect = "../../effects/explosion.lua", frames = 30 },
      { name = "explosion 50", effect = "../../effects/explosion.lua", frames = 50 },
      { name = "explosion 70", effect = "../../effects/explosion.lua", frames = 70 },
      { name = "plume 96",     effect = "../../effects/plume.lua",     frames = 96 },
      { name = "plumes 60",    effect = "../../effects/plumes.lua",    frames = 60 },
      { name = "night 30",     effect = "../../effects/night.lua",     frames = 30 },
      { name = "cloud 1",      effect = "../../effects/cloud.lua",     frames = 1 },
    },
    axis { "part",
      { name = "the default" },
      { name = "32 steps",              ["march.steps"] = 32 },
      { name = "64 steps",              ["march.steps"] = 64 },
      { name = "256 steps",             ["march.steps"] = 256 },
      { name = "512 steps",             ["march.steps"] = 512 },
      { name = "tolerance 0.01",        ["march.tolerance"] = 0.01 },
      { name = "tolerance 0.03",        ["march.tolerance"] = 0.03 },
      { name = "shadow_resolution 32",  ["lighting.shadow_resolution"] = 32 },
      { name = "shadow_resolution 64",  ["lighting.shadow_resolution"] = 64 },
      { name = "shadow_resolution 128", ["lighting.shadow_resolution"] = 128 },
      { name = "shadow_resolution 192", ["lighting.shadow_resolution"] = 192 },
      { name = "near_steps 1",          ["march.near_steps"] = 1 },
      { name = "near_steps 2",          ["march.near_steps"] = 2 },
      { name = "glow_resolution 8",     ["lighting.glow_resolution"] = 8 },
      { name = "glow_resolution 16",    ["lighting.glow_resolution"] = 16 },
      { name = "glow_resolution 24",    ["lighting.glow_resolution"] = 24 },
      { name = "0 sweeps",              ["lighting.sweeps"] = 0 },
      { name = "1 sweep",               ["lighting.sweeps"] = 1 },
      { name = "2 sweeps",              ["lighting.sweeps"] = 2 },
      { name = "8 sweeps",              ["lighting.sweeps"] = 8 },
      { name = "no glow, once",         ["march.scattering"] = "single" },
      { name = "no glow, 2 octaves",    ["march.scattering"] = "octaves", ["march.octaves"] = 2 },
      { name = "no glow, 4 octaves",    ["march.scattering"] = "octaves", ["march.octaves"] = 4 },
      { name = "no glow, 8 octaves",    ["march.scattering"] = "octaves", ["march.octaves"] = 8 },
      { name = "no fire lights",        ["lighting.fire_lights"] = 0 },
    },
  },
  -- Parts are measured in two scenes, the others are seen as they are.
  skip = function(row)
    return row.part ~= "the default" and row.scene ~= "explosion 30" and row.scene ~= "cloud 1"
  end,
  reference = { samples = 1024, part = "the default" },
}
