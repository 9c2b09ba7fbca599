// Rays that miss the volume's box: what a software device fills in for them
// (pass/march/march_around.h) is what they would find. Rays of one thread out of a team are all
// marched.
#include "pass_test.h"

enum { WIDTH = 91, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

typedef struct picture {
    float *color, *light, *reach, *edge;
} picture;

static const field *ball(pass_world *w, const float at[4]) { // w: radius
    const field *shape =
        row(w, "sphere", SET("position", triple(w, at[0], at[1], at[2])),
            SET("radius", number(w, at[3])), SET("falloff", number(w, 0.4f * at[3])));
    return row(w, "mul", SET("a", shape), SET("b", number(w, 6)));
}

static picture take(gpu *device, const float at[4], bool marched) {
    pass_world w;
    world_open(&w, device);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", ball(&w, at)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 2, 1, 0.5f)));
    if (marched) gpu_test_ok(pass_set_uniform(p, "threads", number(&w, 1)));
    gpu_test_ok(pass_declare(p));
    static const char *const others[] = {"transmittance", "reach", "edge"};
    for (size_t i = 0; i < COUNT_OF(others); i++)
        graph_add_output(w.host.graph, pass_output(p, others[i]));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    picture out = {world_read(&w, pass_output(p, "color")),
                   world_read(&w, pass_output(p, "transmittance")),
                   world_read_depth(&w, pass_output(p, "reach")),
                   world_read_depth(&w, pass_output(p, "edge"))};
    world_close(&w);
    return out;
}

static void expect_near(const float *a, const float *b, size_t count, const char *name) {
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(a[i] - b[i]) <= 2e-3f * fmaxf(1, fabsf(b[i]))))
            fail_msg("%s at %zu: %g and %g", name, i, (double)a[i], (double)b[i]);
}

static int count_lit(const picture *p) {
    int lit = 0;
    for (int i = 0; i < PIXELS; i++) lit += p->color[4 * i] > 0;
    return lit;
}

static void free_picture(picture p) {
    mem_free(p.color);
    mem_free(p.light);
    mem_free(p.reach);
    mem_free(p.edge);
}

static void rays_beside_the_volume_see_what_is_behind(void **state) {
    static const struct {
        float at[4];
        bool seen;
    } balls[] = {
        {{0, 0, 0, 0.3f}, true},        {{-1.2f, 0, 0.7f, 0.3f}, true},
        {{1.3f, 1, -0.6f, 0.2f}, true}, {{3, 0, 0, 1.8f}, true}, // over the edge of the picture
        {{0, -1, 1.6f, 1}, true},       {{0, -5, 0, 1}, true},   // around the camera
        {{0.5f, -4.5f, 0, 1}, true},    {{0, -8, 0, 1}, false},  // behind it
        {{30, 0, 0, 1}, false},
    };
    for (size_t i = 0; i < COUNT_OF(balls); i++) {
        picture filled = take(*state, balls[i].at, false), all = take(*state, balls[i].at, true);
        expect_near(filled.color, all.color, 4 * (size_t)PIXELS, "color");
        expect_near(filled.light, all.light, 4 * (size_t)PIXELS, "transmittance");
        expect_near(filled.reach, all.reach, PIXELS, "reach");
        expect_near(filled.edge, all.edge, PIXELS, "edge");
        int lit = count_lit(&all);
        if ((lit > 0) != balls[i].seen) fail_msg("ball %zu: %d pixels show it", i, lit);
        assert_int_equal(count_lit(&filled), lit);
        free_picture(filled);
        free_picture(all);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_beside_the_volume_see_what_is_behind),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
