// How easily gas moves across the lower faces of each cell (pyro_coefficients): for the finest level from which
// cells are solid, and from their densities; with COARSE for each other one from the level before.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#ifdef COARSE
#include "sim/pyro/levels.glsl"
uniform vec3 coarse_size, coarser; // cells; of the finer level along each axis for one of them
uniform int coarse_first;
layout(std430) readonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
layout(std430) buffer PyroCoarseCoefficients { PYRO_COEFFICIENTS coarse_coefficients[]; };

void main() {
    ivec3 to = ivec3(gl_GlobalInvocationID), size = ivec3(coarse_size), n = ivec3(coarser);
    if (any(greaterThanEqual(to, size))) return;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n.x * n.y * n.z; i++) {
        ivec3 in_ = ivec3(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        sum += pyro_coefficients(coefficients[level_at(to * n + in_)]) * vec4(vec3(n) * vec3(equal(in_, ivec3(0))), 1.0);
    }
    coarse_coefficients[coarse_first + to.x + size.x * (to.y + size.y * to.z)] =
        pyro_store_coefficients(sum / float(n.x * n.y * n.z));
}
#else
layout(std430) writeonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
#if PYRO_SOLIDS
#include "sim/pyro/bodies.glsl"
#endif
#if PYRO_VARIABLE
#include "sim/pyro/density.glsl"
#endif

// Across the face between a cell and its neighbour.
float coefficient_between(ivec3 c, ivec3 other) {
#if PYRO_SOLIDS
    if (pyro_body_at(c) != 0u || pyro_body_at(other) != 0u) return 0.0;
#endif
#if PYRO_VARIABLE
    return 2.0 / (pyro_density_at(c) + pyro_density_at(other));
#else
    return 1.0;
#endif
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    float is_gas = 1.0;
#if PYRO_SOLIDS
    is_gas = float(pyro_body_at(c) == 0u);
#endif
    coefficients[pyro_at(c)] = pyro_store_coefficients(vec4(coefficient_between(c, pyro_into(c - ivec3(1, 0, 0))),
                                            coefficient_between(c, pyro_into(c - ivec3(0, 1, 0))),
                                            coefficient_between(c, pyro_into(c - ivec3(0, 0, 1))), is_gas));
}
#endif
