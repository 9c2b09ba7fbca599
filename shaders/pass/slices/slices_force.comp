// What pushes slices in some places, before each of their steps.
layout(local_size_x = 16, local_size_y = 8, local_size_z = 1) in;
//@ field vec3 force : acceleration (m/s^2): to the right, upwards; places: shares of the slice's width
//@ field float shape = 1 : how much of it acts in a place
#define FLOW_SOURCES
#include "fields.glsl"
#include "pass/slices/place.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!flow_inside(at.xy) || at.z >= FLOW_SLICES) return;
    flow_source s = flow_no_source();
    if (is_first == 0u) FLOW_SOURCE_LOAD(at.xy, at.z, s);
    vec3 p = slices_place(vec2(at.xy) + 0.5);
    float some = field_shape(p);
    if (some != 0.0) s.push += some * duration * field_force(p).xy;
    FLOW_SOURCE_STORE(at.xy, at.z, s);
}
