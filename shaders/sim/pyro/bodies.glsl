// Which cells are of solids. The gas has a body for each of its cells; a larger cell of velocity is
// solid where at least half of it is.
#ifndef SIM_PYRO_BODIES_GLSL
#define SIM_PYRO_BODIES_GLSL
layout(std430) readonly buffer SolidIds { uint ids[]; }; // x fastest; 0: gas

uint pyro_body_of(ivec3 gas_cell) {
    return ids[gas_cell.x + PYRO_GAS_NX * (gas_cell.y + PYRO_GAS_NY * gas_cell.z)];
}

uint pyro_body_at(ivec3 c) {
#if PYRO_SIDE == 1
    return pyro_body_of(c);
#else
    uint body = 0u;
    int count = 0;
    for (int i = 0; i < 8; i++) {
        uint one = pyro_body_of(2 * c + ivec3(i & 1, (i >> 1) & 1, i >> 2));
        body = max(body, one);
        count += int(one != 0u);
    }
    return count >= 4 ? body : 0u;
#endif
}
#endif
