-- expect error: 'swrl': no matching overloaded function found
local fx = effect { name = "glsl" }
fx.output = march { density = sphere {} * glsl { "support/swirl.glsl", "swrl", 1, { 1, 1, 1 } } }
