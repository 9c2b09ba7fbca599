// What tests of a live effect share: a small effect of several files that they edit, a session that
// follows it, and looks at its picture.
#pragma once
#include "roil_test.h"

enum { WIDTH = 32, HEIGHT = 18 };

// Red: frames so far / 1024. Green: `gain`. Blue: a number of an included file.
static const char SHADER[] = "// Counts.\n"
                             "#include \"part.glsl\"\n"
                             "//@ option mode = plain {plain, double} : how gain is shown\n"
                             "uniform float gain;                //= 1 [0, 1] : green\n"
                             "uniform sampler2D before;          //= input history color : past\n"
                             "writeonly uniform image2D color;   //= output rgba16f : picture\n"
                             "void main() {\n"
                             "    ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                             "    if (any(greaterThanEqual(p, imageSize(color)))) return;\n"
                             "    float count = texelFetch(before, p, 0).r + 1.0 / 1024.0;\n"
                             "    float green = MODE == MODE_DOUBLE ? 2.0 * gain : gain;\n"
                             "    imageStore(color, p, vec4(count, green, part(), 1.0));\n"
                             "}\n";

static const char SCRIPT[] = "local fx = effect { name = 'test', fps = 24, frames = 100 }\n"
                             "local more = require 'more'\n"
                             "local gain = param { 'gain', %s, min = 0, max = 1 }\n"
                             "local count = shader { 'count.comp', gain = gain * more, %s }\n"
                             "fx.output = count.color\n"
                             "%s\n"
                             "return fx\n";

static char script_path[512];

static inline void put(const char *name, const char *text) {
    char path[512];
    write_text(name, text, path);
}

static inline void put_script(const char *gain, const char *pass, const char *end) {
    char text[2048];
    snprintf(text, sizeof text, SCRIPT, gain, pass, end);
    write_text("test.lua", text, script_path);
}

static inline void put_part(const char *number) {
    char text[128];
    snprintf(text, sizeof text, "float part() { return %s; }\n", number);
    put("part.glsl", text);
}

typedef struct session {
    roil_live *live;
    double frame; // drawn next
} session;

// Draws a frame; `pixel` is the linear colour in the middle of the picture, as far as sRGB tells.
static inline void draw(session *s, int red, double green, double blue) {
    roil_effect *e = roil_live_effect(s->live);
    if (!e) fail_msg("no effect: %s", roil_live_message(s->live));
    ok(roil_advance(e, s->frame));
    s->frame++;
    static uint8_t pixels[WIDTH * HEIGHT * 4];
    ok(roil_read(e, false, pixels));
    expect_pixel(pixels, WIDTH, WIDTH / 2, HEIGHT / 2, srgb((float)red / 1024), srgb((float)green),
                 srgb((float)blue), 1);
}

static inline bool update(session *s) {
    roil_live_wait(s->live);
    return roil_live_update(s->live, WIDTH, HEIGHT, s->frame);
}

static inline void expect_good(session *s) {
    assert_true(update(s));
    if (roil_live_message(s->live)) fail_msg("%s", roil_live_message(s->live));
}

static inline void expect_broken(session *s, const char *part) {
    assert_true(update(s));
    const char *message = roil_live_message(s->live);
    if (!message || !strstr(message, part))
        fail_msg("'%s' does not say '%s'", message ? message : "(no message)", part);
}

static inline void put_all(void) {
    put("count.comp", SHADER);
    put("more.lua", "return 1");
    put_part("0.25");
    put_script("0.5", "", "");
}

static inline session begin_with(roil *r, const roil_setting *settings, size_t count) {
    put_all();
    session s = {.frame = 1};
    s.live = roil_live_create(
        r, &(roil_live_desc){.file = script_path, .settings = settings, .setting_count = count});
    ok(s.live);
    return s;
}

static inline session begin(roil *r) {
    session s = begin_with(r, NULL, 0);
    expect_good(&s);
    return s;
}

static inline void end(session *s) {
    roil_live_destroy(s->live);
}
