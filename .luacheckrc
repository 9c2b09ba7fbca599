-- What luacheck (Debian: lua-check) takes as known in Lua files of roil, whose sandbox has no io, os and debug:
-- `luacheck effects scripts`. tests/program/editors.py holds the list of words against `roil info --json`.
local words = {
  "abs", "accumulate", "add", "advect", "atan", "bake", "bands", "blast", "blast_arrival", "blast_impulse",
  "blast_pressure", "blast_velocity", "bloom", "box", "bright", "camera", "capsule", "clamp", "curl",
  "curve", "deposit", "disc", "div", "dot", "effect", "exp", "explosions", "final", "floor", "forward",
  "fract", "geometry", "glsl", "history", "image", "instance_glow", "instance_index", "instance_random",
  "instance_state", "instances", "layers", "lbm", "length", "lerp", "light_index", "light_random",
  "lighting", "maps", "march", "material", "max", "mesh", "meter", "min", "mix", "mul", "negate", "node", "orbit",
  "outline", "over", "over_age", "palette", "param", "particle_age", "particle_quantity", "particle_random",
  "particle_velocity", "particles", "perlin", "pick", "pieces", "point_light", "point_light_glows",
  "point_lights", "position", "pow", "pyro", "quantise", "raw", "reference", "remap", "rgb", "saturate",
  "scatter", "shade", "shader", "shadow_maps", "shell", "shell_age", "shell_depth", "shell_displacement",
  "shell_normal", "shell_random", "shell_shift", "shell_view", "simplex", "sin", "sky", "slices",
  "smoothstep", "sphere", "sphere_light", "splats", "spot_light", "sqrt", "stack", "step", "sub", "sun",
  "tile", "time", "torus", "transform", "value", "vdb", "vec", "voxels", "warp", "worley",
}

std = "lua54"
not_globals = { "io", "os", "debug", "package", "coroutine", "load", "loadfile", "dofile", "collectgarbage" }
max_line_length = false -- tests/rules/format.py
read_globals = words
files["scripts/prelude.lua"] = { globals = words }
files["scripts/bench"] = { read_globals = { "axis", "sweep", "zip" } }
exclude_files = { "tests/fuzz", "build", "scripts/start/vdb.lua" } -- the last is filled in before it is one
