// The pressure's equation of a step: its coefficients on the finest level and the next five, what
// remains of it with the pressure of the last step (src/sim/flow.h), and what its residual is
// measured against. A group does 32 x 32 cells, a thread 2 x 2.
//
// A template that blends p with alpha in every iteration, p = (1 - alpha) (neighbours - div) / 4 +
// alpha p', comes to rest where the equation has lambda (p - p') more, with lambda = 4 alpha / (1 -
// alpha): the equation stays symmetric, and any solver for it does what the blending would.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_OBSTACLES readonly
#define FLOW_TEMPLATES readonly
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

// Size, where coefficients begin, 1 when the level is wanted: bits of whole numbers.
uniform vec4 level_bits[6];
uniform int coefficients; // 0: those of the last step hold
uniform float pressure_unit; // of 1 m^2/s^2
layout(std430) writeonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowVelocity { vec2 velocity[]; };
layout(std430) readonly buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowResidual { float residual[]; };

const float MOST_ALPHA = 0.9995;

bool is_solid(ivec2 cell, int slice) {
#if FLOW_WITH_OBSTACLES
    return flow_obstacles[flow_cell(cell, slice)].x >= 0.5;
#else
    return false;
#endif
}

// In 64ths.
uint face(ivec2 cell, ivec2 beyond, int kind, int slice) {
    beyond = flow_around(beyond, FLOW_SIZE);
    if (!flow_inside(beyond)) return kind == FLOW_OPEN ? 128u : 0u;
    return is_solid(beyond, slice) ? 0u : 64u;
}

uint faces_of(ivec2 cell, int slice) {
    if (is_solid(cell, slice)) return 0u;
    return flow_faces_pack(uvec4(face(cell, cell - ivec2(1, 0), FLOW_FACE_LEFT, slice),
                                 face(cell, cell + ivec2(1, 0), FLOW_FACE_RIGHT, slice),
                                 face(cell, cell - ivec2(0, 1), FLOW_FACE_BOTTOM, slice),
                                 face(cell, cell + ivec2(0, 1), FLOW_FACE_TOP, slice)));
}

// Lambda, and lambda times the pressure of the template.
vec2 held(ivec2 cell, uint faces, int slice) {
#if FLOW_WITH_TEMPLATES
    vec2 t = flow_clean(flow_templates[flow_cell(cell, slice)]);
    float alpha = min(t.x, MOST_ALPHA);
    if (alpha < 1e-4 || faces == 0u) return vec2(0.0);
    float lambda = 4.0 * alpha / (1.0 - alpha);
    return vec2(lambda, lambda * pressure_unit * t.y);
#else
    return vec2(0.0);
#endif
}

float divergence(ivec2 cell, int slice) {
    ivec2 next = cell + 1;
    if (FLOW_AROUND_X && next.x == FLOW_NX) next.x = 0;
    if (FLOW_AROUND_Y && next.y == FLOW_NY) next.y = 0;
    vec2 here = velocity[flow_corner(cell, slice)];
    return velocity[flow_corner(ivec2(next.x, cell.y), slice)].x - here.x +
           velocity[flow_corner(ivec2(cell.x, next.y), slice)].y - here.y;
}

float pressure_of(ivec2 cell, int slice) {
    cell = flow_around(cell, FLOW_SIZE);
    return flow_inside(cell) ? pressure[flow_cell(cell, slice)] : 0.0;
}

float image(ivec2 cell, vec4 faces, float lambda, int slice) {
    float own = pressure[flow_cell(cell, slice)];
    const ivec2 x = ivec2(1, 0), y = ivec2(0, 1);
    vec4 others = vec4(pressure_of(cell - x, slice), pressure_of(cell + x, slice),
                       pressure_of(cell - y, slice), pressure_of(cell + y, slice));
    return dot(faces, own - others) + lambda * own;
}

ivec4 level_of(int level) {
    return floatBitsToInt(level_bits[level]);
}

// ---- levels -----------------------------------------------------------------------------------

shared uint shared_faces[16 * 16];
shared float shared_held[16 * 16];

void put(int level, ivec2 cell, int slice, uint faces, float lambda) {
    ivec4 l = level_of(level);
    if (!flow_within(cell, l.xy)) return;
    uint at = uint(l.z + (slice * l.y + cell.y) * l.x + cell.x);
    flow_coefficients[at] = uvec2(faces, floatBitsToUint(lambda));
}

// `wide`: how many cells of the level a tile has along an axis.
void coarsen(int level, int wide, int slice) {
    ivec2 p = ivec2(gl_LocalInvocationID.xy), cell = ivec2(gl_WorkGroupID.xy) * wide + p;
    bool mine = all(lessThan(p, ivec2(wide)));
    barrier();
    uvec4 children = uvec4(0u);
    float lambda = 0.0;
    for (int k = 0; mine && k < 4; k++) {
        int at = (2 * p.y + (k >> 1)) * 16 + 2 * p.x + (k & 1);
        children[k] = shared_faces[at];
        lambda += shared_held[at];
    }
    uint faces = flow_faces_coarse(children, lessThan(2 * cell + 1, level_of(level - 1).xy));
    barrier();
    if (!mine) return;
    shared_faces[p.y * 16 + p.x] = faces;
    shared_held[p.y * 16 + p.x] = lambda;
    put(level, cell, slice, faces, lambda);
}

void main() {
    int slice = int(gl_WorkGroupID.z);
    ivec2 p = ivec2(gl_LocalInvocationID.xy), coarse = ivec2(gl_WorkGroupID.xy) * 16 + p;
    uvec4 children = uvec4(0u);
    float lambda = 0.0;
    vec2 means = vec2(0.0);
    vec4 sums = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 cell = 2 * coarse + ivec2(k & 1, k >> 1);
        if (!flow_inside(cell)) continue;
        children[k] = faces_of(cell, slice);
        vec4 faces = flow_faces_of(children[k]);
        vec2 hold = held(cell, children[k], slice);
        float d = dot(faces, vec4(1.0)) + hold.x, given = hold.y - divergence(cell, slice);
        float r = given - image(cell, faces, hold.x, slice);
        lambda += hold.x;
        residual[flow_cell(cell, slice)] = d > 0.0 ? r : 0.0;
        if (coefficients != 0) put(0, cell, slice, children[k], hold.x);
        if (d == 0.0) continue;
        vec2 scaled = 4.0 / d * vec2(given, r);
        sums += vec4(scaled * scaled, 1.0, hold.x > 0.0 ? 1.0 : 0.0);
        means += vec2(r, pressure[flow_cell(cell, slice)]);
    }
    flow_leave(slice, FLOW_PARTS_BUILD, sums);
    flow_leave(slice, FLOW_PARTS_MEAN, vec4(means, 0.0, 0.0));
    if (gl_WorkGroupID.xy == uvec2(0u) && gl_LocalInvocationIndex < FLOW_KNOWN)
        flow_known[slice * FLOW_KNOWN + gl_LocalInvocationIndex] = 0.0;
    if (coefficients == 0) return;
    uint faces = flow_faces_coarse(children, lessThan(2 * coarse + 1, FLOW_SIZE));
    int at = int(gl_LocalInvocationIndex);
    shared_faces[at] = faces;
    shared_held[at] = lambda;
    if (level_of(1).w != 0) put(1, coarse, slice, faces, lambda);
    for (int level = 2, wide = 8; level < 6 && level_of(level).w != 0; level++, wide /= 2)
        coarsen(level, wide, slice);
}
