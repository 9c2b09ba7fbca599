// One part of a mesh, as geometry.vert and geometry.frag are told of it (pass/geometry.c).
struct part_block {
    mat4 transform; // object to world
    vec4 color;     // base colour, linear
    uvec4 range;    // first index, 1 when textured, 0, 0
};
layout(std140, binding = 1) uniform Part { part_block part; };
