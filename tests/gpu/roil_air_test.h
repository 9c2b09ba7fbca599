// Air that rises from a box, for tests: a script of it, and pictures of an upright slice through
// it.
#pragma once
#include "roil_test.h"

enum { WIDE = 16, HIGH = 24 };

// The upright slice through the middle of the box, cell by cell.
static const char SLICE[] =
    "// A slice.\n"
    "//@ field float value : shown\n"
    "#include \"fields.glsl\"\n"
    "writeonly uniform image2D color; //= output rgba16f : it\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
    "    if (any(greaterThanEqual(at, size))) return;\n"
    "    vec2 uv = (vec2(at) + 0.5) / vec2(size);\n"
    "    vec3 p = vec3(mix(-0.8, 0.8, uv.x), 0.05, mix(2.4, 0.0, uv.y));\n"
    "    imageStore(color, at, vec4(vec3(field_value(p)), 1.0));\n"
    "}\n";

// %s: frames a second, more keys of the air, more of the file; what is shown.
static const char SCRIPT[] =
    "local fx = effect { name = 'air', fps = %g, frames = 1000 }\n"
    "local strength = param { 'strength', 1, min = 0, max = 9 }\n"
    "local air = lbm { size = {16, 16, 24}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6, %s }\n"
    "air:source { shape = box { position = {0.2, 0, 0.5}, size = {0.4, 0.4, 0.4} }, temperature = "
    "1,\n"
    "             density = strength * curve { {0, 0.9}, {0.3, 0.1}, {0.5, 0.5} } }\n"
    "%s\n"
    "local shown = shader { 'slice.comp', value = %s }\n"
    "fx.output = shown.color\n"
    "return fx\n";

typedef uint8_t picture[WIDE * HIGH * 4];

static inline void script(char out[2048], double fps, const char *keys, const char *more,
                          const char *shown) {
    snprintf(out, 2048, SCRIPT, fps, keys, more, shown);
}

static inline roil_effect *open(roil *r, double fps, const char *keys, const char *more) {
    char text[2048], path[512];
    script(text, fps, keys, more, "air.density");
    write_text("slice.comp", SLICE, path);
    roil_effect *e = load_text(r, "air.lua", text);
    ok(roil_prepare(e, WIDE, HIGH));
    return e;
}

static inline void draw(roil_effect *e, double frame, picture out) {
    ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static inline int at(const picture p, int x, int y) {
    return p[4 * (y * WIDE + x)];
}

static inline void is_same(const picture a, const picture b, int slack) {
    for (int i = 0; i < WIDE * HIGH; i++)
        if (abs(a[4 * i] - b[4 * i]) > slack)
            fail_msg("texel %d, %d: %d is not %d", i % WIDE, i / WIDE, a[4 * i], b[4 * i]);
}

static inline int brightest(const picture p) {
    int most = 0;
    for (int i = 0; i < WIDE * HIGH; i++)
        if (p[4 * i] > most) most = p[4 * i];
    return most;
}

// Of what is shown, the mean row, from above.
static inline double height_of(const picture p) {
    double sum = 0, weighted = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        sum += p[4 * i];
        weighted += p[4 * i] * (double)(i / WIDE);
    }
    assert_true(sum > 0);
    return weighted / sum;
}

static inline double readout(roil_effect *e, const char *name) {
    roil_readout all[32];
    size_t count = roil_readouts(e, all, 32);
    for (size_t i = 0; i < count && i < 32; i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no readout '%s' of %zu", name, count);
    return 0;
}

static const char CUBE[] =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\n"
    "v 1 1 1\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n"
    "f 2 4 8 6\n";
