return {
  density = 9, tint = {1, 0.5, 2}, look = "lumpy", on = true,
  fire = { {0, "#000000"}, {0.5, {0, 3, 0}, 0.5}, {1, "#ffffff"} },
  fade = { {0, 2}, {1, 1}, shape = "cubic" }, ["camera.eye"] = {1, -3, 1},
}
