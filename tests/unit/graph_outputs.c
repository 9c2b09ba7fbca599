// Outputs that come and go: what is kept for a while to be looked at, and let go again.
#include "graph_fake_gpu.h"

typedef struct chain { // first -> second -> third -> last; `aside` is read by nobody
    graph *g;
    graph_image first, second, third, last, aside;
} chain;

static bool record_nothing(void *user, graph *g, gpu *device) {
    (void)user, (void)g, (void)device;
    return true;
}

static void step(graph *g, const char *name, graph_image read, graph_image read_too,
                 graph_image written) {
    graph_image reads[] = {read, read_too};
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = reads,
                                                     .read_count = 2,
                                                     .writes = &written,
                                                     .write_count = 1,
                                                     .record = record_nothing}));
}

// With `past`, the second image also reads what it was in the last frame.
static chain chain_create(bool past) {
    chain c = {.g = graph_create()};
    c.first = image(c.g, "first");
    c.second = image(c.g, "second");
    c.third = image(c.g, "third");
    c.last = image(c.g, "last");
    c.aside = image(c.g, "aside");
    graph_image none = {0}, before = past ? graph_add_history(c.g, c.second) : none;
    step(c.g, "a", none, none, c.first);
    step(c.g, "b", c.first, before, c.second);
    step(c.g, "c", c.second, none, c.third);
    step(c.g, "d", c.third, none, c.last);
    step(c.g, "e", none, none, c.aside);
    graph_add_output(c.g, c.last);
    compile(c.g);
    return c;
}

static void ready(chain *c, gpu *device) {
    compile(c->g);
    if (!graph_allocate(c->g, device)) fail_msg("graph_allocate: %s", err_get());
    assert_true(graph_execute(c->g, device));
}

static void chain_end(chain *c, gpu *device) {
    graph_destroy(c->g, device);
    assert_int_equal(device->alive, 0);
    strbuf_free(&device->log);
}

static void an_output_is_alone_in_its_memory(void **state) {
    (void)state;
    chain c = chain_create(false);
    assert_true(graph_shares_memory(c.g, c.first, c.third));
    assert_false(graph_is_alone(c.g, c.first));
    assert_false(graph_is_alone(c.g, c.third));
    assert_true(graph_is_alone(c.g, c.last));
    graph_add_output(c.g, c.first);
    assert_false(graph_is_alone(c.g, c.first)); // nothing is known until it is compiled
    compile(c.g);
    assert_true(graph_is_alone(c.g, c.first));
    assert_false(graph_shares_memory(c.g, c.first, c.third));
    graph_destroy(c.g, NULL);
}

static void a_culled_image_is_not_alone_but_absent(void **state) {
    (void)state;
    chain c = chain_create(false);
    assert_false(graph_is_alone(c.g, c.aside));
    assert_order(c.g, "a b c d");
    graph_add_output(c.g, c.aside);
    compile(c.g);
    assert_true(graph_is_alone(c.g, c.aside));
    assert_order(c.g, "a b c d e");
    graph_destroy(c.g, NULL);
}

static void a_removed_output_is_culled_and_shared_again(void **state) {
    (void)state;
    chain c = chain_create(false);
    graph_add_output(c.g, c.first);
    graph_add_output(c.g, c.aside);
    compile(c.g);
    graph_remove_output(c.g, c.first);
    graph_remove_output(c.g, c.aside);
    graph_remove_output(c.g, c.second); // was none
    compile(c.g);
    assert_true(graph_shares_memory(c.g, c.first, c.third));
    assert_order(c.g, "a b c d");
    graph_remove_output(c.g, c.last);
    compile(c.g);
    assert_order(c.g, "");
    graph_destroy(c.g, NULL);
}

static void histories_survive_outputs_that_come_and_go(void **state) {
    (void)state;
    gpu device = {0};
    chain c = chain_create(true);
    ready(&c, &device);
    gpu_image *now = graph_get_image(c.g, c.second), *last = graph_get_image(c.g, c.last);
    graph_add_output(c.g, c.first);
    graph_add_output(c.g, c.aside);
    strbuf_free(&device.log);
    ready(&c, &device);
    assert_ptr_equal(graph_get_image(c.g, graph_find_image(c.g, "second history")), now);
    assert_ptr_equal(graph_get_image(c.g, c.last), last);
    assert_null(strstr(strbuf_text(&device.log), "clear"));
    now = graph_get_image(c.g, c.second);
    graph_remove_output(c.g, c.first);
    graph_remove_output(c.g, c.aside);
    ready(&c, &device);
    assert_ptr_equal(graph_get_image(c.g, graph_find_image(c.g, "second history")), now);
    assert_null(strstr(strbuf_text(&device.log), "clear"));
    chain_end(&c, &device);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_output_is_alone_in_its_memory),
        cmocka_unit_test(a_culled_image_is_not_alone_but_absent),
        cmocka_unit_test(a_removed_output_is_culled_and_shared_again),
        cmocka_unit_test(histories_survive_outputs_that_come_and_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
