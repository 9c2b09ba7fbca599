// Where gas can flow between solids: of each cell how far the faces at its lower ends are open, and 1
// where it is gas. Once for the finest level, from whose cells are of which body; with COARSE for each
// other one, from the level before.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#ifdef COARSE
#include "sim/pyro/levels.glsl"
uniform vec3 coarse_size, coarser; // cells; of the finer level along each axis for one of them
uniform int coarse_first;
layout(std430) readonly buffer PyroOpenings { uint openings[]; };
layout(std430) buffer PyroCoarseOpenings { uint coarse_openings[]; };

void main() {
    ivec3 to = ivec3(gl_GlobalInvocationID), size = ivec3(coarse_size), n = ivec3(coarser);
    if (any(greaterThanEqual(to, size))) return;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n.x * n.y * n.z; i++) {
        ivec3 in_ = ivec3(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        vec4 open_ = unpackUnorm4x8(openings[level_at(to * n + in_)]);
        sum += open_ * vec4(vec3(n) * vec3(equal(in_, ivec3(0))), 1.0);
    }
    coarse_openings[coarse_first + to.x + size.x * (to.y + size.y * to.z)] =
        packUnorm4x8(sum / float(n.x * n.y * n.z));
}
#else
#include "sim/pyro/bodies.glsl"
layout(std430) writeonly buffer PyroOpenings { uint openings[]; };

bool is_gas(ivec3 c) {
    return pyro_body_at(pyro_into(c)) == 0u;
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    bool gas = is_gas(c);
    vec3 low = vec3(is_gas(c - ivec3(1, 0, 0)), is_gas(c - ivec3(0, 1, 0)), is_gas(c - ivec3(0, 0, 1)));
    openings[pyro_at(c)] = packUnorm4x8(gas ? vec4(low, 1.0) : vec4(0.0));
}
#endif
