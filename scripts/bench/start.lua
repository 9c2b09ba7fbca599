-- How soon a new process is done: with what it and the driver have compiled before, and with empty caches.
--
--   roil bench scripts/bench/start.lua -o out/start
--   roil bench scripts/bench/start.lua -o out/start --repeats 3

return sweep {
  name = "start", title = "Start of the program", measure = "start",
  notes = { "check: loads and compiles the effect without a device. render: the same and one frame of 96x54, saved." },
  effect = "../../effects/explosion.lua", size = {96, 54}, frames = 30, warmup = 1, repeats = 20,
  axes = { axis { "command", "check", "render" }, axis { "cache", "warm", "empty" } },
}
