// Where slices are given density, temperature, dye and speed, before each of their steps. What is
// not given stays as the flow has it.
layout(local_size_x = 16, local_size_y = 8, local_size_z = 1) in;
//@ option mode = hold {hold, add} : the flow takes on these values, or gets them on top every second
//@ field float shape : how much of a place is inflow, 0 to 1; places: shares of the slice's width
//@ field float density = 0 : smoke
//@ field float temperature = 0 : heat
//@ field float dye = 0 : a second colour of smoke
//@ field vec3 velocity = {0, 0, 0} : m/s: to the right, upwards
uniform float rate; //= 0 [0, 1e4] 1/s : of hold: how fast the flow takes on these values; 0: at once
uniform float variation;
#define FLOW_SOURCES
#include "fields.glsl"
#include "pass/slices/place.glsl"
#include "lib/noise.glsl"

// Each slice has its own, finer than most inflow is and quicker than it turns over, so that slices
// with the same inflow come to differ, and left from right.
float variety_at(vec3 p, int slice) {
    const float cells = 24.0, speed = 6.0; // a width, a second
    return noise_perlin3(vec3(p.xy * cells, now * speed), noise_hash(variety + uint(slice)), 0.0);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!flow_inside(at.xy) || at.z >= FLOW_SLICES) return;
    flow_source s = flow_no_source();
    if (is_first == 0u) FLOW_SOURCE_LOAD(at.xy, at.z, s);
    float cover = SLICES_COVER(field_shape, at.xy);
    if (cover > 0.0) {
        vec3 p = slices_place(vec2(at.xy) + 0.5);
        float more = variation > 0.0 ? 1.0 + variation * variety_at(p, at.z) : 1.0;
#if MODE == MODE_HOLD
        if (rate > 0.0) cover *= 1.0 - exp(-rate * duration);
#if HAS_DENSITY
        flow_hold(s, 0, cover, field_density(p) * more);
#endif
#if HAS_TEMPERATURE
        flow_hold(s, 1, cover, field_temperature(p) * more);
#endif
#if HAS_DYE
        flow_hold(s, 2, cover, field_dye(p) * more);
#endif
#if HAS_VELOCITY
        flow_hold_velocity(s, cover, field_velocity(p).xy * more);
#endif
#else
        s.add += cover * duration * more * vec3(field_density(p), field_temperature(p), field_dye(p));
        s.push += cover * duration * more * field_velocity(p).xy;
#endif
    } else if (is_first == 0u) {
        return;
    }
    FLOW_SOURCE_STORE(at.xy, at.z, s);
}
