// Values between cells. Positions are in cells from the box's lowest corner; they lie in the box.
#ifndef SIM_PYRO_SAMPLE_GLSL
#define SIM_PYRO_SAMPLE_GLSL

uniform vec3 inflow; // m/s, across faces that are PYRO_INFLOW

// Two coordinates along each axis as places, and the weight of the higher one.
struct pyro_span {
    int low[3], high[3];
    vec3 t;
    bool wall; // the higher one is the last face of the axis, whose velocity is known
};

// `face`: the axis along which values lie on faces; 3: in the middle of cells along all.
pyro_span pyro_span_at(vec3 p, const int face) {
    pyro_span s;
    s.wall = false;
    for (int axis = 0; axis < 3; axis++) {
        float at = axis == face ? p[axis] : p[axis] - 0.5, low = floor(at);
        int i = int(low), j = i + 1, last = PYRO_SIZE[axis] - 1;
        s.t[axis] = at - low;
        if (PYRO_AROUND[axis]) {
            i = pyro_into(axis, i);
            j = pyro_into(axis, j);
        } else if (axis == face) {
            if (PYRO_HIGH[axis] != PYRO_OPEN && j > last) s.wall = true;
            i = clamp(i, PYRO_LOW[axis] == PYRO_OPEN ? 1 : 0, last);
            j = clamp(j, PYRO_LOW[axis] == PYRO_OPEN ? 1 : 0, last);
        } else {
            i = clamp(i, 0, last);
            j = clamp(j, 0, last);
        }
        s.low[axis] = pyro_place(axis, i);
        s.high[axis] = pyro_place(axis, j);
    }
    return s;
}

// The eight values of one component of an array: those that are low along x first.
#define PYRO_EIGHT(from, axis, s, low4, high4)                                                     \
    {                                                                                              \
        int a_ = s.low[1] + s.low[2], b_ = s.high[1] + s.low[2];                                   \
        int c_ = s.low[1] + s.high[2], d_ = s.high[1] + s.high[2];                                 \
        low4 = vec4(pyro_load(from[a_ + s.low[0]], axis), pyro_load(from[b_ + s.low[0]], axis),    \
                    pyro_load(from[c_ + s.low[0]], axis), pyro_load(from[d_ + s.low[0]], axis));   \
        high4 = vec4(pyro_load(from[a_ + s.high[0]], axis), pyro_load(from[b_ + s.high[0]], axis), \
                     pyro_load(from[c_ + s.high[0]], axis), pyro_load(from[d_ + s.high[0]], axis));\
    }

float pyro_mix(vec4 low, vec4 high, vec3 t) {
    vec4 x = mix(low, high, t.x);
    vec2 y = mix(x.xz, x.yw, t.y);
    return mix(y.x, y.y, t.z);
}

// Velocities at the last face of an axis are known.
void pyro_close(const int axis, pyro_span s, inout vec4 low, inout vec4 high) {
    if (!s.wall) return;
    float v = PYRO_HIGH[axis] == PYRO_INFLOW ? inflow[axis] : 0.0;
    if (axis == 0) high = vec4(v);
    if (axis == 1) low.yw = high.yw = vec2(v);
    if (axis == 2) low.zw = high.zw = vec2(v);
}

// ---- velocities -------------------------------------------------------------------------------

// Component `axis` across a face, whose other coordinates are those of cells in the box.
#define PYRO_FACE(name, from)                                                                     \
    float name(const int axis, ivec3 f) {                                                          \
        int last = PYRO_SIZE[axis] - 1;                                                            \
        if (PYRO_AROUND[axis]) {                                                                   \
            if (f[axis] > last) f[axis] = 0;                                                       \
        } else {                                                                                   \
            if (PYRO_HIGH[axis] == PYRO_OPEN) {                                                    \
                f[axis] = min(f[axis], last);                                                      \
            } else if (f[axis] > last) {                                                           \
                return PYRO_HIGH[axis] == PYRO_INFLOW ? inflow[axis] : 0.0;                        \
            }                                                                                      \
            if (PYRO_LOW[axis] == PYRO_OPEN) f[axis] = max(f[axis], 1);                            \
        }                                                                                          \
        return pyro_load(from[pyro_at(f)], axis);                                        \
    }

// Whether a place that is not in the box is beyond a face that air can pass.
bool pyro_is_beyond(vec3 p) {
    for (int axis = 0; axis < 3; axis++) {
        if (PYRO_AROUND[axis]) continue;
        if (p[axis] < 0.0 && PYRO_LOW[axis] != PYRO_WALL) return true;
        if (p[axis] > float(PYRO_SIZE[axis]) && PYRO_HIGH[axis] != PYRO_WALL) return true;
    }
    return false;
}

// Into the box: around, or the nearest place in it.
vec3 pyro_into(vec3 p) {
    vec3 size = vec3(PYRO_SIZE);
    for (int axis = 0; axis < 3; axis++)
        p[axis] = PYRO_AROUND[axis] ? p[axis] - size[axis] * floor(p[axis] / size[axis])
                                    : clamp(p[axis], 0.0, size[axis]);
    return p;
}
#endif
