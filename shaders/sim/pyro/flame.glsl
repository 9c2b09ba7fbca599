// How a premixed flame moves into mixture (Peters 2000, section 2.4).
#ifndef SIM_PYRO_FLAME_GLSL
#define SIM_PYRO_FLAME_GLSL

layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; }; // before the step

// Into the box: around, or the nearest place in it. Positions are in cells from its lowest corner.
vec3 pyro_into(vec3 p) {
    vec3 size = vec3(PYRO_SIZE);
    return mix(clamp(p, vec3(0.0), size), p - size * floor(p / size), PYRO_AROUND);
}

// Two coordinates along each axis as places, and the weight of the higher one.
struct pyro_span {
    ivec3 low, high;
    vec3 t;
};

pyro_span pyro_span_at(vec3 p) { // a place in the box
    vec3 at = p - 0.5, low = floor(at);
    ivec3 i = ivec3(low), j = i + 1, last = PYRO_SIZE - 1;
    pyro_span s;
    s.t = at - low;
    s.low = pyro_places(mix(clamp(i, ivec3(0), last), pyro_around(i), PYRO_AROUND));
    s.high = pyro_places(mix(clamp(j, ivec3(0), last), pyro_around(j), PYRO_AROUND));
    return s;
}

float progress_mix(float v[8], vec3 t) {
    vec4 x = mix(vec4(v[0], v[2], v[4], v[6]), vec4(v[1], v[3], v[5], v[7]), t.x);
    vec2 y = mix(x.xz, x.yw, t.y);
    return mix(y.x, y.y, t.z);
}

// Progress of the eight cells around a place, and where it is between them.
#define PROGRESS_EIGHT(p, v, part)                                                                 \
    float v[8];                                                                                    \
    vec3 part;                                                                                     \
    {                                                                                              \
        pyro_span s_ = pyro_span_at(pyro_into(p));                                                 \
        int a_ = s_.low.y + s_.low.z, b_ = s_.high.y + s_.low.z;                                   \
        int c_ = s_.low.y + s_.high.z, d_ = s_.high.y + s_.high.z;                                 \
        part = s_.t;                                                                               \
        v[0] = pyro_progress(pyro_load(gas[a_ + s_.low.x])), v[1] = pyro_progress(pyro_load(gas[a_ + s_.high.x])); \
        v[2] = pyro_progress(pyro_load(gas[b_ + s_.low.x])), v[3] = pyro_progress(pyro_load(gas[b_ + s_.high.x])); \
        v[4] = pyro_progress(pyro_load(gas[c_ + s_.low.x])), v[5] = pyro_progress(pyro_load(gas[c_ + s_.high.x])); \
        v[6] = pyro_progress(pyro_load(gas[d_ + s_.low.x])), v[7] = pyro_progress(pyro_load(gas[d_ + s_.high.x])); \
    }

// The progress that the flame brings to gas that came `from` there in this step: that of gas behind, less
// its own. Gas that is `lighter` than the mixture before the flame flows away behind it: through such gas
// it moves faster, and as much air passes it.
float flame(vec3 from, float lighter) {
    PROGRESS_EIGHT(from, here, t)
    vec3 slope;
    slope.x = here[1] - here[0] + here[3] - here[2] + here[5] - here[4] + here[7] - here[6];
    slope.y = here[2] - here[0] + here[3] - here[1] + here[6] - here[4] + here[7] - here[5];
    slope.z = here[4] - here[0] + here[5] - here[1] + here[6] - here[2] + here[7] - here[3];
    float steep = length(slope);
    if (steep < 1e-4) return 0.0;
    PROGRESS_EIGHT(from + slope / steep * (flame_reach * lighter), behind, u)
    return progress_mix(behind, u) - progress_mix(here, t);
}
#endif
