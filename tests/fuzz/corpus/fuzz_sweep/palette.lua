return sweep { name = "p", effect = "puff.lua", frames = 1, set = { fire = { {0, "#000"}, {1, {4, 2, 0.5}, 0.8} }, fade = { {0, 1}, {2, 0}, shape = "cubic" } } }
