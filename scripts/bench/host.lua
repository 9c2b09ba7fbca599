-- What the host does for a frame: scripts, numbers, bindings and commands, without the device.
--
--   roil bench scripts/bench/host.lua -o out/host
--
-- "host" is the processor time of the thread that submits, so pictures are small: they cost the device.

return sweep {
  name = "host", title = "Host time of a frame", size = {96, 54}, frames = "26-45", settle = 0,
  axes = { axis { "effect", "../../effects/explosion.lua", "../../effects/night.lua", "../../effects/forest_fire.lua",
                  "../../effects/layered_explosion.lua" } },
}
