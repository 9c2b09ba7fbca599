// Cells within solids hold what the gas around them does, so that parabolas beside them bend as if it went on.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#define PYRO_ON_GAS
#include "sim/pyro/state.glsl"
#include "sim/pyro/bodies.glsl"

layout(std430) buffer PyroGasTo { PYRO_FOUR gas_to[]; };
#if PYRO_SMOKE
layout(std430) buffer PyroSmokeTo { float smoke_to[]; };
#endif

void fill(ivec3 c) {
    vec4 sum = vec4(0.0);
    float count = 0.0, smoke = 0.0;
    for (int i = 0; i < 6; i++) {
        ivec3 step_ = ivec3(i >> 1 == 0, i >> 1 == 1, i >> 1 == 2) * (2 * (i & 1) - 1);
        ivec3 other = pyro_into(c + step_);
        if (pyro_body_at(other) != 0u) continue;
        sum += pyro_load(gas_to[pyro_at(other)]);
#if PYRO_SMOKE
        smoke += smoke_to[pyro_at(other)];
#endif
        count++;
    }
    gas_to[pyro_at(c)] = pyro_store(sum / max(count, 1.0));
#if PYRO_SMOKE
    smoke_to[pyro_at(c)] = smoke / max(count, 1.0);
#endif
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (pyro_body_at(c) != 0u) fill(c);
}
