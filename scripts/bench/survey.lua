-- The survey of Raseta, Lesar and Bohak, "Real-time volumetric explosion special effects for games"
-- (2025), section 4.2: four frames with 128 steps, quarter resolution and Worley noise by curl, which
-- they showed beside frames of Blender. Here, beside what roil makes of the same data. `scripts/survey`
-- lays the pictures out with these times.
--
--   roil bench scripts/bench/survey.lua -o out/survey
--   roil bench scripts/bench/survey.lua -o out/survey --size 480x270       -- small

return sweep {
  name = "survey", title = "The frames of the published survey",
  notes = { "Published: 62.85 ms a frame, against 8 minutes of Blender; on which card is not said." },
  size = {1920, 1080}, warmup = 2, repeats = 3, limit = 120,
  axes = {
    axis { "look", { name = "published", effect = "../../effects/paper.lua", noise_bake = "exact" },
                   { name = "ours", effect = "../../effects/explosion.lua" } },
    axis { "frames", 10, 30, 50, 70 },
  },
}
