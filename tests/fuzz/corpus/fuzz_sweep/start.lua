return sweep { name = "s", effect = "puff.lua", measure = "start", time = {1, 2}, axes = { axis { "command", "check", "render" }, axis { "cache", "warm", "empty" } } }
