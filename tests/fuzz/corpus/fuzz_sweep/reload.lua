return sweep { name = "r", effect = "puff.lua", measure = "reload", axes = { axis { "edit", { name = "n", edit = {"1", "2"} } } } }
