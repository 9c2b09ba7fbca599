local sizes = { {96, 54}, {48, 27} }
return sweep { name = "full", title = "All of it", notes = { "one", "two" }, effect = "puff.lua", size = {640, 360}, frames = "2-4",
  warmup = 3, repeats = 2, limit = 9, settle = 0, compare = 2, counters = false, set = { opacity = 20, ["camera.eye"] = {1, 2, 3} },
  axes = { axis { "steps", 16, 32, label = "s" }, zip { axis { "size", sizes[1], sizes[2] }, axis { "noise", "perlin", "worley" } },
    axis { "part", { name = "all" }, { name = "less", ["march.steps"] = 8, set = { size = 2 }, frames = {1, 3} } } },
  reference = { samples = 4, steps = 99, part = "all" },
  skip = function(row) return row.s == 16 and row.noise == "worley" end,
  published = function(row) return { card = row.steps / 3 } end }
