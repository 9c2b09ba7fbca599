// What one sees of a medium along a ray: the point that half of what comes from it lies before, and
// what fields are there. One group looks at the whole ray.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
//@ option sampling = linear {linear, quasi_cubic, cubic, nearest} : interpolation of the grids that the fields sample
//@ field float density = 0 : of the medium (1/m)
//@ field vec4 value_0 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_1 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_2 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_3 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_4 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_5 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_6 = {0, 0, 0, 0} : what is asked for there
//@ field vec4 value_7 = {0, 0, 0, 0} : what is asked for there
#include "fields.glsl"
uniform vec3 origin;
uniform vec3 way;       // of length 1
uniform float nearest;  // m from the origin
uniform float farthest; // m
layout(std430) buffer Probed { vec4 probed[]; }; // the point, and its density; then the values
const uint LANES = 64u, EACH = 8u, STEPS = LANES * EACH;
const float THIN = 1e-4; // of what is seen; less is nothing
shared float depths[STEPS]; // optical, of each step
shared vec3 found;
shared bool any_found;

void find() {
    float through = 1.0, sum = 0.0, half_sum = 0.0;
    for (uint i = 0u; i < STEPS; i++) through *= exp(-depths[i]);
    sum = 1.0 - through;
    any_found = sum > THIN;
    through = 1.0;
    for (uint i = 0u; i < STEPS; i++) {
        float seen = through * (1.0 - exp(-depths[i]));
        if (half_sum + seen >= 0.5 * sum) {
            float inside = seen > 0.0 ? (0.5 * sum - half_sum) / seen : 0.5;
            found = origin + way * mix(nearest, farthest, (float(i) + clamp(inside, 0.0, 1.0)) / float(STEPS));
            return;
        }
        half_sum += seen;
        through *= exp(-depths[i]);
    }
    found = origin + way * farthest;
}

void main() {
    uint lane = gl_LocalInvocationIndex;
    float step_length = (farthest - nearest) / float(STEPS);
    for (uint k = 0u; k < EACH; k++) {
        uint i = k * LANES + lane;
        float density = field_density(origin + way * (nearest + (float(i) + 0.5) * step_length));
        depths[i] = isnan(density) ? 0.0 : clamp(density, 0.0, 1e9) * step_length;
    }
    barrier();
    if (lane == 0u) find();
    barrier();
    if (lane != 0u) return;
    vec3 p = found;
    probed[0] = vec4(p, any_found ? max(field_density(p), 0.0) : -1.0);
    probed[1] = field_value_0(p);
    probed[2] = field_value_1(p);
    probed[3] = field_value_2(p);
    probed[4] = field_value_3(p);
    probed[5] = field_value_4(p);
    probed[6] = field_value_5(p);
    probed[7] = field_value_6(p);
    probed[8] = field_value_7(p);
}
