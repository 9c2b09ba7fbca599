// The state of air at rest, and of scalars at their ambient values: whatever the parity, since it
// is the same everywhere. Not a pass of its own: see src/sim/lbm.c.
layout(local_size_x = LBM_GROUP) in;
#define LBM_BUNDLED (LBM_BUNDLE > 1)
#include "sim/lbm/state.glsl"

uniform vec3 ambient;

void main() {
    uint column = gl_GlobalInvocationID.x;
    if (column >= LBM_LAYER) return;
    lbm_place place = lbm_place_at(uvec3(column % LBM_NX, column / LBM_NX, gl_GlobalInvocationID.z));
    lbm_access air[LBM_Q], carried[LBM_SCALAR_Q];
    for (int i = 0; i < LBM_Q; i++) air[i] = lbm_in_all_rows(lbm_pack(1.0, lbm_float(0.0)));
    lbm_send_air(place, air);
    lbm_float g[LBM_SCALAR_Q];
#define SCALAR(s)                                                                                  \
    lbm_set_scalar_equilibrium(lbm_float(ambient[s]), lbm_vec_all(vec3(0.0)), g);                  \
    for (int i = 0; i < LBM_SCALAR_Q; i++)                                                         \
        carried[i] = lbm_in_all_rows(lbm_pack(LBM_SCALAR_SCALE, g[i]));                            \
    lbm_send_scalar(s, place, carried);
    LBM_EACH_SCALAR(SCALAR)
#undef SCALAR
}
