// The state and the inputs of a solver of 2D flow (src/sim/flow.h), for its own shaders and those
// of others: flow_defines and flow_bind in src/sim/flow.h give what this needs.
//
// A shader says before the include which buffers it uses, and how, by defining any of
//   FLOW_STATE      scalars and velocities before the step (read only)
//   FLOW_SOURCES    what is set, added and pushed in the step
//   FLOW_OBSTACLES  where solids are
//   FLOW_TEMPLATES  the pressure that is blended in
// as readonly, writeonly or nothing (both). What is written is written for all cells of all slices:
// nothing is cleared between steps.
#ifndef SIM_FLOW_STATE_GLSL
#define SIM_FLOW_STATE_GLSL

// FLOW_NX, FLOW_NY: cells; FLOW_SLICES; FLOW_FACE_LEFT, _RIGHT, _BOTTOM, _TOP: one of
#define FLOW_CLOSED 0
#define FLOW_OPEN 1
#define FLOW_PERIODIC 2
#define FLOW_AROUND_X (FLOW_FACE_LEFT == FLOW_PERIODIC)
#define FLOW_AROUND_Y (FLOW_FACE_BOTTOM == FLOW_PERIODIC)

// ---- where things are -------------------------------------------------------------------------

const ivec2 FLOW_SIZE = ivec2(FLOW_NX, FLOW_NY);
// Velocities have one column and one row more, of the faces at the end, and rows of whole 32 bytes.
const int FLOW_ROW = (FLOW_NX + 4) / 4 * 4;

bool flow_inside(ivec2 cell) {
    return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, FLOW_SIZE));
}

// Where a cell lies in a buffer: it is in the slice.
uint flow_cell(ivec2 cell, int slice) {
    return uint((slice * FLOW_NY + cell.y) * FLOW_NX + cell.x);
}

// The same behind what a buffer has of all cells.
uint flow_cell_behind(ivec2 cell, int slice) {
    return uint(FLOW_SLICES * FLOW_NY * FLOW_NX) + flow_cell(cell, slice);
}

uint flow_corner(ivec2 cell, int slice) { // of velocities: up to and with FLOW_SIZE
    return uint((slice * (FLOW_NY + 1) + cell.y) * FLOW_ROW + cell.x);
}

// ---- numbers ----------------------------------------------------------------------------------

// What is no number, or beyond all reason, is 0. By its bits: compilers may take it that there are
// no such values.
float flow_clean(float v) {
    return (floatBitsToUint(v) & 0x7fffffffu) < 0x60000000u ? v : 0.0;
}
vec2 flow_clean(vec2 v) {
    return vec2(flow_clean(v.x), flow_clean(v.y));
}
vec4 flow_clean(vec4 v) {
    return vec4(flow_clean(v.xy), flow_clean(v.zw));
}

// ---- the state --------------------------------------------------------------------------------

#ifdef FLOW_STATE
layout(std430) readonly buffer FlowScalars { vec4 flow_scalars[]; }; // [flow_cell]
layout(std430) readonly buffer FlowVelocity { vec2 flow_velocity[]; }; // [flow_corner], staggered

// Density, temperature, dye, and 0.
vec4 flow_scalars_of(ivec2 cell, int slice) {
    return flow_scalars[flow_cell(cell, slice)];
}

// In the middle of a cell, m/s.
vec2 flow_velocity_of(ivec2 cell, int slice) {
    ivec2 next = cell + 1;
    if (FLOW_AROUND_X && next.x == FLOW_NX) next.x = 0;
    if (FLOW_AROUND_Y && next.y == FLOW_NY) next.y = 0;
    vec2 here = flow_velocity[flow_corner(cell, slice)];
    float right = flow_velocity[flow_corner(ivec2(next.x, cell.y), slice)].x;
    float above = flow_velocity[flow_corner(ivec2(cell.x, next.y), slice)].y;
    return 0.5 * (here + vec2(right, above));
}
#endif

// ---- sources ----------------------------------------------------------------------------------

// What happens to a cell in a step, after it has moved: scalars = scalars * (1 - share) + add, and
// the velocity around it, (u, v) = (u, v) * (1 - share.w) + push. So a value that is held in a
// region that covers c of the cell is share = c, add = c * value; a rate is add = rate * dt; a
// force push = acceleration * dt.
struct flow_source {
    vec4 share; // of density, temperature, dye, velocity: 0 to 1
    vec3 add;   // density, temperature, dye
    vec2 push;  // m/s
};

flow_source flow_no_source() {
    return flow_source(vec4(0.0), vec3(0.0), vec2(0.0));
}

// What a region that covers `cover` of the cell makes of what others said. One of the four: 0
// density, 1 temperature, 2 dye.
void flow_hold(inout flow_source s, int which, float cover, float value) {
    s.share[which] = 1.0 - (1.0 - s.share[which]) * (1.0 - cover);
    s.add[which] = s.add[which] * (1.0 - cover) + value * cover;
}
void flow_hold_velocity(inout flow_source s, float cover, vec2 value) {
    s.share.w = 1.0 - (1.0 - s.share.w) * (1.0 - cover);
    s.push = s.push * (1.0 - cover) + value * cover;
}

#ifdef FLOW_SOURCES
// [3 * flow_cell]: share; add; push.
layout(std430) FLOW_SOURCES buffer FlowSources { vec4 flow_sources[]; };

#define FLOW_SOURCE_STORE(cell, slice, s)                                                          \
    {                                                                                              \
        uint flow_at_ = 3u * flow_cell(cell, slice);                                               \
        flow_sources[flow_at_] = (s).share;                                                        \
        flow_sources[flow_at_ + 1u] = vec4((s).add, 0.0);                                          \
        flow_sources[flow_at_ + 2u] = vec4((s).push, 0.0, 0.0);                                    \
    }
#define FLOW_SOURCE_LOAD(cell, slice, s)                                                           \
    {                                                                                              \
        uint flow_at_ = 3u * flow_cell(cell, slice);                                               \
        s = flow_source(flow_sources[flow_at_], flow_sources[flow_at_ + 1u].xyz,                   \
                        flow_sources[flow_at_ + 2u].xy);                                           \
    }
// A force on top of what is there.
#define FLOW_PUSH_ADD(cell, slice, push) flow_sources[3u * flow_cell(cell, slice) + 2u].xy += (push)
#endif

// ---- obstacles --------------------------------------------------------------------------------

#ifdef FLOW_OBSTACLES
// How much of the cell is solid, the velocity of that (m/s), and 0. A cell is solid from one half.
layout(std430) FLOW_OBSTACLES buffer FlowObstacles { vec4 flow_obstacles[]; };
#endif

// ---- templates --------------------------------------------------------------------------------

// In every iteration of the solver p = mix(p, pressure, alpha): pressure templates.
struct flow_template {
    float alpha;    // 0 to 1
    float pressure; // m^2/s^2
};

// What one more template makes of those before it.
void flow_blend(inout flow_template t, float alpha, float pressure) {
    float left = t.alpha * (1.0 - alpha), all_ = left + alpha;
    if (all_ <= 0.0) return;
    t = flow_template(all_, (left * t.pressure + alpha * pressure) / all_);
}

#ifdef FLOW_TEMPLATES
layout(std430) FLOW_TEMPLATES buffer FlowTemplates { vec2 flow_templates[]; }; // [flow_cell]
#define FLOW_TEMPLATE_STORE(cell, slice, t)                                                        \
    flow_templates[flow_cell(cell, slice)] = vec2((t).alpha, (t).pressure)
#endif
#endif
