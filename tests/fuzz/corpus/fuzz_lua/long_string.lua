local s = string.rep("a", 1 << 30)
