-- Time of whole effects by the size of the picture.
--
--   roil bench scripts/bench/size.lua -o out/size
--   roil bench scripts/bench/size.lua -o out/size --size 480x270 --frames 30       -- the largest becomes this

return sweep {
  name = "size", title = "Size of the picture",
  frames = "24-35", warmup = 8, limit = 120,
  axes = {
    axis { "effect", "../../effects/explosion.lua", "../../effects/night.lua", "../../effects/cloud.lua", "../../effects/plume.lua",
           "../../effects/plumes.lua", "../../effects/paper.lua" },
    axis { "size", {480, 270}, {960, 540}, {1440, 810}, {1920, 1080}, {3840, 2160} },
  },
}
