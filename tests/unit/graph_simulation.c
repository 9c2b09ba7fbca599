// Passes that simulate run for frames that are not drawn, with what they read and nothing else.
#include "graph_fake_gpu.h"

static bool record_nothing(void *user, graph *g, gpu *device) {
    (void)user, (void)g, (void)device;
    return true;
}

static void step(graph *g, const char *name, graph_image read, graph_image written,
                 bool simulates) {
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = &read,
                                                     .read_count = 1,
                                                     .writes = &written,
                                                     .write_count = 1,
                                                     .simulates = simulates,
                                                     .record = record_nothing}));
}

typedef struct scene {
    graph *g;
    graph_image noise, air, sky, picture;
} scene;

// noise -> air -> picture; the sky is by its side.
static scene make(bool simulates) {
    scene s = {.g = graph_create()};
    s.noise = image(s.g, "noise");
    s.air = image(s.g, "air");
    s.sky = image(s.g, "sky");
    s.picture = image(s.g, "picture");
    step(s.g, "bake", (graph_image){0}, s.noise, false);
    step(s.g, "sky", (graph_image){0}, s.sky, false);
    step(s.g, "step", s.noise, s.air, simulates);
    graph_image reads[] = {s.air, s.sky, graph_add_history(s.g, s.picture)};
    assert_true(graph_add_pass(s.g, &(graph_pass_desc){.name = "march",
                                                       .reads = reads,
                                                       .read_count = 3,
                                                       .writes = &s.picture,
                                                       .write_count = 1,
                                                       .record = record_nothing}));
    return s;
}

static void what_is_simulated_runs_alone(void **state) {
    (void)state;
    gpu device = {0};
    scene s = make(true);
    graph_add_output(s.g, s.picture);
    compile(s.g);
    assert_true(graph_simulates(s.g));
    assert_true(graph_feeds_simulation(s.g, s.noise));
    assert_false(graph_feeds_simulation(s.g, s.air)); // only the picture looks at it
    assert_false(graph_feeds_simulation(s.g, s.sky));
    assert_false(graph_feeds_simulation(s.g, (graph_image){0}));
    assert_true(graph_allocate(s.g, &device));
    assert_true(graph_execute_simulation(s.g, &device)); // histories are not touched
    assert_string_equal(strbuf_text(&device.log), "begin bake;end;begin step;end;");
    graph_destroy(s.g, &device);
    strbuf_free(&device.log);
}

static void nothing_is_simulated_without_need(void **state) {
    (void)state;
    scene s = make(false), unread = make(true);
    graph_add_output(s.g, s.picture);
    compile(s.g);
    assert_false(graph_simulates(s.g));
    assert_false(graph_feeds_simulation(s.g, s.noise));
    graph_add_output(unread.g, unread.sky);
    compile(unread.g);
    assert_false(graph_simulates(unread.g));
    graph_destroy(s.g, NULL);
    graph_destroy(unread.g, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_simulated_runs_alone),
        cmocka_unit_test(nothing_is_simulated_without_need),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
