local fx = effect { name = "volumes" }
pcall(vdb, { "data/*.vdb", fps = 24, loop = "ping_pong", blend = true, offset = { 0, 0, 1 } })
pcall(raw, { "data/x.raw", type = "f16", size = { 8, 8, 8 }, frames = 2, stride = 1024, skip = 4 })
pcall(mesh, { "x.obj", position = { 1, 2, 3 }, color = "#ff8800" })
pcall(require, "x.y")
local g = glsl { "swirl.glsl", "swirl", 2, components = 3 }
fx.output = final { shader { "tint.comp", geometry {}, strength = 0.5 }, format = { color = "rgba8" } }
