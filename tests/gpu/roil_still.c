// Pictures that are kept, and a window that goes on while a frame is at work: with one device for
// both, and with two.
#include "base/memory.h"
#include "roil_test.h"

enum { N = 64, BYTES = N * N * 4 };

static const char shader[] =
    "// Grey by the time, from left to right.\n"
    "#include \"lib/frame.glsl\"\n"
    "uniform float turns; //= 1 [0, 100000] : of a loop that changes nothing\n"
    "writeonly uniform image2D color; //= output rgba16f : the picture\n"
    "void main() {\n"
    "    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
    "    float sum = 0.0;\n"
    "    for (float i = 0.0; i < turns; i += 1.0) sum += sin(sum + i);\n"
    "    float grey = fract(frame.time.x * 0.1) * float(pixel.x) / 64.0;\n"
    "    imageStore(color, pixel, vec4(grey + min(sum, 0.0) * 1e-9));\n"
    "}\n";

static roil *open_apart(void) {
    roil *r = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(r);
    assert_int_equal(roil_shows_apart(r), roil_is_software(r));
    return r;
}

static void close_apart(roil *r) {
    test_messages += roil_validation_messages(r);
    roil_destroy(r);
}

static roil_effect *open_grey(roil *r) {
    char path[512];
    write_text("grey.comp", shader, path);
    roil_effect *e = load_text(r, "grey.lua",
                               "local fx = effect { name = 'grey', fps = 1, frames = 9 }\n"
                               "fx.output = shader { 'grey.comp' }.color\n"
                               "return fx\n");
    ok(roil_prepare(e, N, N));
    return e;
}

static void show(roil *r, const roil_picture *p, uint8_t out[BYTES]) {
    roil_picture all = *p;
    all.width = all.height = N;
    all.view[2] = all.view[3] = N;
    ok(roil_show(r, &all));
    ok(roil_read_shown(r, out));
}

static void wait_for(roil *r, roil_still *s) {
    while (!roil_still_ready(r, s)) assert_false(roil_is_lost(r));
}

static void keep_and_show(roil *r) {
    static uint8_t as_drawn[BYTES], later[BYTES], again[BYTES];
    roil_effect *e = open_grey(r);
    assert_null(roil_still_create(e));
    assert_non_null(strstr(roil_error(), "render a frame first"));
    ok(roil_render(e, 3));
    show(r, &(roil_picture){.effect = e}, as_drawn);
    roil_still *s = roil_still_create(e);
    ok(s);
    assert_int_equal(roil_still_bytes(s), N * N * 8);
    ok(roil_render(e, 8));
    show(r, &(roil_picture){.effect = e}, later);
    assert_memory_not_equal(as_drawn, later, BYTES);
    wait_for(r, s);
    show(r, &(roil_picture){.effect = e, .still = s}, again);
    assert_memory_equal(as_drawn, again, BYTES);
    show(r, &(roil_picture){.effect = e}, again); // a still that is shown no more leaves no trace
    assert_memory_equal(later, again, BYTES);
    roil_unload(e);
    show(r, &(roil_picture){.still = s}, again); // it outlives the effect
    assert_memory_equal(as_drawn, again, BYTES);
    roil_still_destroy(r, s);
}

static void a_still_shows_what_was_drawn(void **state) {
    keep_and_show(*state);
}

static void a_still_comes_from_another_device(void **state) {
    (void)state;
    roil *r = open_apart();
    keep_and_show(r);
    close_apart(r);
}

static void a_window_is_shown_while_a_frame_is_at_work(void **state) {
    static uint8_t before[BYTES], during[BYTES], after[BYTES];
    (void)state;
    roil *r = open_apart();
    roil_effect *e = open_grey(r);
    ok(roil_render(e, 3));
    roil_still *first = roil_still_create(e);
    ok(first);
    wait_for(r, first);
    show(r, &(roil_picture){.still = first}, before);
    ok(roil_set(e, "grey.turns", "60000")); // some seconds
    ok(roil_render(e, 8));
    roil_still *second = roil_still_create(e);
    ok(second);
    assert_true(roil_pending(r) > 0);
    show(r, &(roil_picture){.still = first}, during);
    assert_memory_equal(before, during, BYTES);
    if (roil_shows_apart(r)) assert_true(roil_pending(r) > 0 && !roil_still_ready(r, second));
    wait_for(r, second);
    show(r, &(roil_picture){.still = second}, after);
    assert_memory_not_equal(before, after, BYTES);
    while (roil_pending(r)) assert_false(roil_is_lost(r));
    roil_still_destroy(r, first);
    roil_still_destroy(r, second);
    roil_unload(e);
    close_apart(r);
}

static void what_is_inspected_is_brought_over(void **state) {
    static uint8_t one[BYTES], two[BYTES];
    uint8_t *const out[] = {one, two};
    roil *const both[] = {*state, open_apart()};
    for (int i = 0; i < 2; i++) {
        roil *r = both[i];
        roil_effect *e = open_grey(r);
        ok(roil_render(e, 8));
        roil_texture *t = roil_texture_create(r, N, N, NULL);
        roil_texel texel;
        const roil_inspection how = {
            .image = "grey.color", .channels = 7, .center = {0.5f, 0.5f}, .zoom = 1};
        ok(t);
        ok(roil_inspect(e, &how, t, &texel));
        static const roil_vertex corners[] = {{0, 0, 0, 0, UINT32_MAX},
                                              {N, 0, 1, 0, UINT32_MAX},
                                              {0, N, 0, 1, UINT32_MAX},
                                              {N, N, 1, 1, UINT32_MAX}};
        static const uint32_t indices[] = {0, 1, 2, 2, 1, 3};
        const roil_draw draw = {.texture = t, .count = 6, .clip = {0, 0, N, N}};
        show(r,
             &(roil_picture){.vertices = corners,
                             .indices = indices,
                             .draws = &draw,
                             .vertex_count = 4,
                             .index_count = 6,
                             .draw_count = 1},
             out[i]);
        roil_texture_destroy(r, t);
        roil_unload(e);
    }
    assert_memory_equal(one, two, BYTES);
    assert_true(one[4 * (N - 1)] > 100); // its right edge is bright
    close_apart(both[1]);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_shows_what_was_drawn),
        cmocka_unit_test(a_still_comes_from_another_device),
        cmocka_unit_test(a_window_is_shown_while_a_frame_is_at_work),
        cmocka_unit_test(what_is_inspected_is_brought_over),
    };
    return test_run(tests);
}
