-- A forest fire: how many trees burn at once, and what its parts take.
--
--   roil bench scripts/bench/fires.lua -o out/fires
--   roil bench scripts/bench/fires.lua -o out/fires --size 480x270 --frames 100-103 --only fires=500
--
-- Trees burn from the beginning, and so long that none is burnt out; after four seconds flames and smoke
-- are as many as they get.

return sweep {
  name = "fires", title = "A forest fire",
  effect = "../../effects/forest_fire.lua", size = {1920, 1080}, frames = "100-119", warmup = 4, limit = 120,
  axes = {
    axis { "fires", 1, 10, 50, 100, 250, 500 },
    axis { "look", "natural", "drawn" },
  },
  set = { burn = 100, speed = 0.1, ["effect.events"] = "" },
}
