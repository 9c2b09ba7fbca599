// The end of a step: velocities less the differences of pressure. With REFLECT, the middle of a step: that
// is where the state is then, and the other half begins as far beyond it.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"

layout(std430) readonly buffer PyroPressure { float pressure[]; };
#if PYRO_REFLECTS
layout(std430) buffer PyroOtherPressure { float other_pressure[]; }; // of the second projection; of the first
#endif
#ifdef REFLECT
layout(std430) writeonly buffer PyroFlowInto { PYRO_FOUR flow_into[]; };
#endif
layout(std430) buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
#if PYRO_WEIGHED
layout(std430) readonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
#endif

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    ivec3 here = pyro_places(c), below = pyro_places(pyro_into(c - 1));
    int at = here.x + here.y + here.z;
    vec3 low = vec3(pressure[below.x + here.y + here.z], pressure[here.x + below.y + here.z],
                    pressure[here.x + here.y + below.z]);
    // Velocities of the first faces stay as they are.
    bvec3 stays = both(equal(c, ivec3(0)), not(PYRO_AROUND));
    vec3 push = pressure[at] - low;
#if PYRO_WEIGHED
    push *= pyro_coefficients(coefficients[at]).xyz;
#endif
    push = mix(push, vec3(0.0), stays);
    vec4 v = pyro_load(velocity_to[at]);
#ifdef REFLECT
    flow_into[at] = pyro_store(v - vec4(push, 0.0));
    push *= 2.0;
    other_pressure[at] = 0.0;
#elif PYRO_REFLECTS
    other_pressure[at] += pressure[at]; // with which the next step begins
#endif
    velocity_to[at] = pyro_store(v - vec4(push, 0.0));
}
