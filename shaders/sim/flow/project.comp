// The end of a step: the pressure as it was found, and the velocity less its gradient.
layout(local_size_x = FLOW_GROUP) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform int iteration; // that would be next
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowDirection { float direction[]; };
layout(std430) readonly buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowPressureTo { float pressure_to[]; };
layout(std430) readonly buffer FlowVelocityFrom { vec2 velocity[]; };
layout(std430) writeonly buffer FlowVelocityTo { vec2 velocity_to[]; };

struct Way { // how far the last direction is still to be followed; what all pressures are less
    float stride, mean;
};

float pressure_of(ivec2 cell, int slice, Way way) {
    cell = flow_around(cell, FLOW_SIZE);
    if (!flow_inside(cell)) return 0.0;
    uint at = flow_cell(cell, slice);
    float p = pressure[at] - way.mean;
    return flow_clean(way.stride == 0.0 ? p : p + way.stride * direction[at]);
}

void project(ivec2 cell, int slice, Way way) {
    uint at = flow_cell(cell, slice), corner = flow_corner(cell, slice);
    uvec2 c = flow_coefficients[at];
    vec4 faces = flow_faces_of(c.x);
    float d = dot(faces, vec4(1.0)) + uintBitsToFloat(c.y), own = pressure_of(cell, slice, way);
    vec2 low = vec2(pressure_of(cell - ivec2(1, 0), slice, way),
                    pressure_of(cell - ivec2(0, 1), slice, way));
    pressure_to[at] = d > 0.0 ? own : 0.0;
    velocity_to[corner] = velocity[corner] - faces.xz * (own - low);
    if (!FLOW_AROUND_X && cell.x == FLOW_NX - 1) {
        uint end = flow_corner(cell + ivec2(1, 0), slice);
        velocity_to[end] = vec2(velocity[end].x + faces.y * own, 0.0);
    }
    if (!FLOW_AROUND_Y && cell.y == FLOW_NY - 1) {
        uint end = flow_corner(cell + ivec2(0, 1), slice);
        velocity_to[end] = vec2(0.0, velocity[end].y + faces.w * own);
    }
}

void main() {
    int slice = int(gl_WorkGroupID.z);
    Way way = Way(0.0, flow_means(slice).y);
    if (!flow_stopped(slice))
        way.stride = flow_stride(slice, iteration, flow_total(slice, FLOW_PARTS_PQ));
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (flow_inside(cell)) project(cell, slice, way);
    }
}
