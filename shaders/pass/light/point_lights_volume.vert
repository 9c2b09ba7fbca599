// A sphere around each point light, as far as it reaches: an icosahedron of which each face is divided into
// four, large enough to hold the sphere. Corners turn so that the far side is what is drawn: it is seen
// from inside, too.
#undef HAS_LIGHTS // the reader's table of lights is not read here
#define HAS_LIGHTS 0
#include "lib/frame.glsl"
#include "lib/point_lights.glsl"
layout(location = 0) flat out int number;

const float OUTER = 1.0709; // over the radius of what it must hold
const float A = 0.52573111, B = 0.85065081;
const vec3 CORNERS[12] = vec3[](vec3(-A, B, 0.0), vec3(A, B, 0.0), vec3(-A, -B, 0.0), vec3(A, -B, 0.0), vec3(0.0, -A, B), vec3(0.0, A, B),
                                vec3(0.0, -A, -B), vec3(0.0, A, -B), vec3(B, 0.0, -A), vec3(B, 0.0, A), vec3(-B, 0.0, -A), vec3(-B, 0.0, A));
const ivec3 FACES[20] = ivec3[](ivec3(0, 11, 5), ivec3(0, 5, 1), ivec3(0, 1, 7), ivec3(0, 7, 10), ivec3(0, 10, 11), ivec3(1, 5, 9), ivec3(5, 11, 4),
                                ivec3(11, 10, 2), ivec3(10, 7, 6), ivec3(7, 1, 8), ivec3(3, 9, 4), ivec3(3, 4, 2), ivec3(3, 2, 6), ivec3(3, 6, 8),
                                ivec3(3, 8, 9), ivec3(4, 9, 5), ivec3(2, 4, 11), ivec3(6, 2, 10), ivec3(8, 6, 7), ivec3(9, 8, 1));

// Corner 0, 1 or 2 of the part 0 to 3 of a face; the last is that in the middle.
vec3 corner_of(ivec3 face, int part, int corner) {
    vec3 own = CORNERS[face[corner]];
    if (part == corner) return own;
    return normalize(own + CORNERS[face[part == 3 ? (corner + 1) % 3 : part]]);
}

void main() {
    point_light l = point_light_of(uint(gl_InstanceIndex));
    int corner = 2 - gl_VertexIndex % 3;
    vec3 out_to = corner_of(FACES[gl_VertexIndex / 12], (gl_VertexIndex / 3) % 4, corner);
    vec4 seen = frame.view * vec4(l.position + OUTER * l.range * out_to, 1.0);
    number = l.index;
    gl_Position = frame.projection * seen;
    gl_Position.z = min(gl_Position.z, gl_Position.w); // what is behind all that is seen is drawn, too
}
