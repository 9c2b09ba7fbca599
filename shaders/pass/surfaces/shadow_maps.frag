// Leaves out what is clear; where nothing is, it is empty.
#include "lib/mesh_color.glsl"
layout(location = 0) in vec2 uv;

void main() {
#if HOLES
    if (mesh_color(uv, vec3(1.0)).a < 0.5) discard;
#endif
}
