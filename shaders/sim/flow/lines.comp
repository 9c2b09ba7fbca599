// The pressure's equation of a mode, which is one along y: each cell and its two neighbours. A group
// solves one by parallel cyclic reduction (Hockney and Jesshope 1981): in each turn a cell's equation
// takes in those of its neighbours, and reaches twice as far.
layout(local_size_x = FLOW_GROUP) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

layout(std430) readonly buffer FlowModes { float modes[]; }; // those, then what the equation makes of each
layout(std430) buffer FlowLines { float lines[]; };

// Of the equation below * p[y - reach] + p[y] + above * p[y + reach] = given.
shared float below[FLOW_NY], above[FLOW_NY], given[FLOW_NY];
const int EACH = (FLOW_NY + FLOW_GROUP - 1) / FLOW_GROUP;

float face(int kind) { // at an end
    return kind == FLOW_CLOSED ? 0.0 : kind == FLOW_OPEN ? 2.0 : 1.0;
}

void load(uint line, float own) {
    const bool open = FLOW_FACE_BOTTOM == FLOW_OPEN || FLOW_FACE_TOP == FLOW_OPEN;
    for (int y = int(gl_LocalInvocationIndex); y < FLOW_NY; y += FLOW_GROUP) {
        bool first = y == 0, last = y == FLOW_NY - 1;
        float low = first ? face(FLOW_FACE_BOTTOM) : 1.0, high = last ? face(FLOW_FACE_TOP) : 1.0;
        // Where nothing holds the pressure, this cell does: what is given has no mean.
        float held = first && !open && own == 0.0 ? 1.0 : 0.0;
        float scale = 1.0 / (own + low + high + held);
        below[y] = first && !FLOW_AROUND_Y ? 0.0 : -scale;
        above[y] = last && !FLOW_AROUND_Y ? 0.0 : -scale;
        given[y] = scale * lines[line + uint(y)];
    }
    barrier();
}

vec3 equation(int y) {
    if (FLOW_AROUND_Y) y = (y + FLOW_NY) % FLOW_NY;
    return y >= 0 && y < FLOW_NY ? vec3(below[y], above[y], given[y]) : vec3(0.0);
}

vec3 reduce(int y, int reach) {
    vec3 own = equation(y), low = equation(y - reach), high = equation(y + reach);
    float scale = 1.0 / (1.0 - own.x * low.y - own.y * high.x);
    return scale * vec3(-own.x * low.x, -own.y * high.y, own.z - own.x * low.z - own.y * high.z);
}

void main() {
    int slice = int(gl_WorkGroupID.y), mode = int(gl_WorkGroupID.x);
    if (flow_stopped(slice)) return;
    const int end = FLOW_AROUND_Y ? FLOW_NY / 2 : FLOW_NY;
    uint line = uint((slice * FLOW_NX + mode) * FLOW_NY);
    load(line, modes[FLOW_NX * FLOW_NX + mode]);
    vec3 next[EACH];
    for (int reach = 1; reach < end; reach *= 2) {
        for (int i = 0; i < EACH; i++)
            next[i] = reduce(int(gl_LocalInvocationIndex) + i * FLOW_GROUP, reach);
        barrier();
        for (int i = 0; i < EACH; i++) {
            int y = int(gl_LocalInvocationIndex) + i * FLOW_GROUP;
            if (y >= FLOW_NY) continue;
            below[y] = next[i].x;
            above[y] = next[i].y;
            given[y] = next[i].z;
        }
        barrier();
    }
    for (int y = int(gl_LocalInvocationIndex); y < FLOW_NY; y += FLOW_GROUP) {
        float p = given[y];
        if (FLOW_AROUND_Y) { // two cells are left that see each other from both sides
            vec3 own = equation(y), other = equation(y + FLOW_NY / 2);
            float mine = own.x + own.y, its = other.x + other.y;
            p = (own.z - mine * other.z) / (1.0 - mine * its);
        }
        lines[line + uint(y)] = p;
    }
}
