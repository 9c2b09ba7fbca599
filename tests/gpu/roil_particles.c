// Particles in simulated air: frames that were left out are as good as drawn ones, for what carries
// them too; and what a submit takes at most changes nothing.
#include "roil_test.h"

enum { SIDE = 24 };

// A map of where they are, seen from the side, by their ages.
static const char SHADER[] =
    "// A map.\n"
    "#include \"lib/particles.glsl\"\n"
    "writeonly uniform image2D color; //= output rgba16f : it\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
    "    if (any(greaterThanEqual(at, size))) return;\n"
    "    float sum = 0.0;\n"
    "    for (uint i = 0u; i < particle_used; i++) {\n"
    "        particle p;\n"
    "        if (!particle_read(i, p)) continue;\n"
    "        vec2 uv = vec2(0.5 + p.position.x / 1.6, 1.0 - p.position.z / 2.4);\n"
    "        if (ivec2(floor(uv * vec2(size))) == at) sum += 0.02 + 0.02 * p.age;\n"
    "    }\n"
    "    imageStore(color, at, vec4(vec3(sum), 1.0));\n"
    "}\n";

static const char SCRIPT[] =
    "local fx = effect { name = 'sparks', fps = 24, frames = 1000 }\n"
    "local air = lbm { size = {16, 16, 24}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6,\n"
    "                  warm_up = %g }\n"
    "air:source { shape = box { position = {0.2, 0, 0.5}, size = {0.4, 0.4, 0.4} }, temperature = "
    "1,\n"
    "             velocity = {0, 0, 1} }\n"
    "local sparks = particles { count = 2000, rate = 2000, lifetime = {0.4, 0.8},\n"
    "                           above = {air.temperature, 0.3}, velocity = air.velocity,\n"
    "                           warm_up = %g }\n"
    "fx.output = shader { 'map.comp', from = sparks }.color\n"
    "return fx\n";

typedef uint8_t picture[SIDE * SIDE * 4];

static roil_effect *open(roil *r, double warm_up) {
    char path[512], text[2048];
    snprintf(text, sizeof text, SCRIPT, warm_up, warm_up);
    write_text("map.comp", SHADER, path);
    roil_effect *e = load_text(r, "sparks.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    return e;
}

static void draw(roil_effect *e, double frame, picture out) {
    ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static void a_jump_is_as_good_as_every_frame(void **state) {
    picture each, jump;
    roil_effect *a = open(*state, 0), *b = open(*state, 0);
    for (int frame = 1; frame <= 13; frame++) draw(a, frame, each);
    draw(b, 13, jump);
    int high = 0, all = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        all += each[4 * i] > 0;
        high += each[4 * i] > 0 && i / SIDE < SIDE - 8; // above the source: the air carries them
    }
    assert_true(all > 20 && high > 5);
    assert_memory_equal(each, jump, sizeof each);
    roil_unload(a);
    roil_unload(b);
}

// A window that cannot wait simulates in short submits: 260 steps of the air before the first frame
// are more than one of them takes.
static void short_submits_change_nothing(void **state) {
    picture whole, parts;
    roil_simulation s;
    roil_effect *a = open(*state, 1.3);
    draw(a, 4, whole);
    roil_unload(a);
    roil *window = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(window);
    roil_effect *b = open(window, 1.3);
    do {
        draw(b, 4, parts);
        assert_true(roil_get_simulation(b, &s));
    } while (s.waiting);
    assert_memory_equal(whole, parts, sizeof whole);
    roil_unload(b);
    test_messages += roil_validation_messages(window);
    roil_destroy(window);
}

static roil_effect *open_alone(roil *r, const char *keys) {
    char path[512], text[2048];
    snprintf(text, sizeof text,
             "local fx = effect { name = 'sparks', fps = 24, frames = 1000 }\n"
             "local sparks = particles { count = 100, %s }\n"
             "fx.output = shader { 'map.comp', from = sparks }.color\n"
             "return fx\n",
             keys);
    write_text("map.comp", SHADER, path);
    roil_effect *e = load_text(r, "alone.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    return e;
}

static void what_fails_at_a_step_is_told(void **state) {
    roil_effect *e = open_alone(*state, "rate = function(t) assert(t < 0.1) return 9 end");
    ok(roil_render(e, 2));
    expect_error(roil_render(e, 5), "rate");
    expect_error(roil_render(e, 6), "particles");
    roil_unload(e);
    e = open_alone(*state, "rate = 9, gravity = function(t) assert(t < 0.1) return 9 end");
    ok(roil_render(e, 2));
    expect_error(roil_render(e, 5), "gravity");
    roil_unload(e);
    e = open_alone(*state, "rate = 9, shape = position.z");
    expect_error(roil_render(e, 2), "'shape' has no end");
    roil_unload(e);
}

static double readout(roil_effect *e, const char *name) {
    roil_readout all[32];
    size_t count = roil_readouts(e, all, COUNT_OF(all));
    for (size_t i = 0; i < count && i < COUNT_OF(all); i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no readout '%s' of %zu", name, count);
    return 0;
}

static void they_tell_of_themselves(void **state) {
    roil_simulation s;
    roil_effect *e = open_alone(*state, "rate = 60, burst = 40, burst_period = 0.5, lifetime = 1");
    ok(roil_render(e, 25)); // a second
    assert_true(readout(e, "born") == 140 && readout(e, "slots") == 100);
    assert_true(readout(e, "steps") == 60 && readout(e, "particle steps") > 0);
    assert_true(roil_get_simulation(e, &s));
    assert_true(fabs(s.reached - 1) < 1e-9);
    assert_non_null(s.trouble);
    if (!strstr(s.trouble, "'count' to 140")) fail_msg("%s", s.trouble);
    roil_unload(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_jump_is_as_good_as_every_frame),
        cmocka_unit_test(what_fails_at_a_step_is_told),
        cmocka_unit_test(they_tell_of_themselves),
        cmocka_unit_test(short_submits_change_nothing),
    };
    return test_run(tests);
}
