// Where there is gas. Half bricks of 8 x 8 x 4 cells, one for each group, are marked when they hold more
// than clean air. Another one, and all within eight cells around it, is left as it is: nothing comes
// farther in a step.
#ifndef SIM_PYRO_PRESENT_GLSL
#define SIM_PYRO_PRESENT_GLSL

uniform int everywhere;   // 1: it is not known where
uniform int present_from; // where the marks of this state begin
layout(std430) buffer PyroActive { uint present[]; };
shared uint busy;

const ivec3 HALF_BRICKS = PYRO_SIZE / ivec3(8, 8, 4);

ivec3 first_of_half_brick() { // its lowest cell
    return ivec3(gl_WorkGroupID) * ivec3(8, 8, 4);
}

int half_brick_at(ivec3 i) {
    return i.x + HALF_BRICKS.x * (i.y + HALF_BRICKS.y * i.z);
}

// The same for all of a group.
bool is_near_gas() {
    if (gl_LocalInvocationIndex == 0u) busy = uint(everywhere);
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < 45u; i += gl_WorkGroupSize.x) {
        ivec3 to = ivec3(gl_WorkGroupID) + ivec3(i % 3u, i / 3u % 3u, i / 9u) - ivec3(1, 1, 2);
        to = mix(clamp(to, ivec3(0), HALF_BRICKS - 1), (to + HALF_BRICKS) % HALF_BRICKS, PYRO_AROUND);
        if (present[present_from + half_brick_at(to)] != 0u) busy = 1u;
    }
    barrier();
    return busy != 0u;
}
#endif
