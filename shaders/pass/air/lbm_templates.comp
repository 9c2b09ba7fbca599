// A group of templates: pictures of pressure or velocity that are put into simulated air for a while, again and
// again, and leave puffs and eddies of their size there (after Krueger and Westermann 2005, 3, in planes).
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
//@ option scale_by = nothing {nothing, density, temperature, dye} : `strength` is times what the air has of that around the template, as it is in each step
//@ option within = nothing {nothing, density, temperature, dye} : templates are put only where the air has from `above` to `below` of that
#include "sim/lbm/collide.glsl"
#include "sim/lbm/scalar.glsl"
#include "pass/air/templates.glsl"

#define SUM(s)                                                                                     \
    if (which == s) {                                                                              \
        lbm_element q[LBM_SCALAR_Q];                                                               \
        lbm_load_scalar(s, place, q);                                                              \
        return lbm_sum_scalar(q)[cell.z / LBM_LAYERS];                                             \
    }

uvec3 cell_at(vec3 at) {
    return uvec3(clamp(ivec3(floor(at)), ivec3(0), ivec3(LBM_NX, LBM_NY, LBM_LAYERS * LBM_LANES) - 1));
}

vec3 way_at(vec3 at) {
    uvec3 cell = cell_at(at);
    uint lane = cell.z / LBM_LAYERS;
    lbm_element q[LBM_Q];
    lbm_load_air(lbm_place_at(uvec3(cell.xy, cell.z % LBM_LAYERS)), q);
    lbm_vec momentum = lbm_sum(q).momentum;
    return vec3(momentum.x[lane], momentum.y[lane], momentum.z[lane]);
}

float quantity_at(int which, vec3 at) {
    uvec3 cell = cell_at(at);
    lbm_place place = lbm_place_at(uvec3(cell.xy, cell.z % LBM_LAYERS));
    LBM_EACH_SCALAR(SUM)
    return 0.0;
}

float scale_of(int which, float value) {
    return value;
}
