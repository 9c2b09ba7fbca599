// Order, culling, and the errors of a graph that makes no sense.
#include "graph_fake_gpu.h"

static void passes_run_as_declared_when_nothing_says_otherwise(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c");
    pass(g, "third", NOTHING, USES(c));
    pass(g, "first", NOTHING, USES(a));
    pass(g, "second", NOTHING, USES(b));
    pass_keeping(g, "end", USES(a, b, c), NOTHING, true);
    compile(g);
    assert_order(g, "third first second end");
    graph_destroy(g, NULL);
}

static void readers_run_after_writers_however_declared(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c"), d = image(g, "d");
    pass(g, "last", USES(b, c), USES(d));
    pass(g, "left", USES(a), USES(b));
    pass(g, "right", USES(a), USES(c));
    pass(g, "source", NOTHING, USES(a));
    graph_add_output(g, d);
    compile(g);
    assert_order(g, "source left right last");
    graph_destroy(g, NULL);
}

static void an_early_pass_is_not_pushed_behind_a_late_one(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c");
    pass(g, "needs_late", USES(c), USES(a));
    pass(g, "free", NOTHING, USES(b));
    pass(g, "late", NOTHING, USES(c));
    graph_add_output(g, a);
    graph_add_output(g, b);
    compile(g);
    assert_order(g, "free late needs_late");
    graph_destroy(g, NULL);
}

static void passes_that_nobody_needs_are_culled(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c");
    pass(g, "make", NOTHING, USES(a));
    pass(g, "debug", USES(a), USES(b));
    pass(g, "debug_more", USES(b), USES(c));
    graph_add_output(g, a);
    compile(g);
    assert_order(g, "make");

    graph_add_output(g, b);
    compile(g);
    assert_order(g, "make debug");
    graph_destroy(g, NULL);
}

static void a_kept_pass_keeps_what_it_reads(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b");
    pass(g, "make", NOTHING, USES(a));
    pass(g, "other", NOTHING, USES(b));
    pass_keeping(g, "measure", USES(a), NOTHING, true);
    compile(g);
    assert_order(g, "make measure");
    graph_destroy(g, NULL);
}

static void a_graph_without_outputs_runs_nothing(void **state) {
    (void)state;
    graph *g = graph_create();
    compile(g);
    assert_order(g, "");
    pass(g, "make", NOTHING, USES(image(g, "a")));
    compile(g);
    assert_order(g, "");
    graph_destroy(g, NULL);
}

static void reading_a_history_keeps_its_writer_and_makes_no_cycle(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image sum = image(g, "sum"), shown = image(g, "shown");
    graph_image past = graph_add_history(g, sum);
    pass(g, "show", USES(past), USES(shown));
    pass(g, "add", USES(past), USES(sum));
    graph_add_output(g, shown);
    compile(g);
    assert_order(g, "show add");
    graph_destroy(g, NULL);
}

static void a_history_that_only_culled_passes_read_keeps_nothing(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image sum = image(g, "sum"), unseen = image(g, "unseen"), seen = image(g, "seen");
    graph_image past = graph_add_history(g, sum);
    pass(g, "add", USES(past), USES(sum));
    pass(g, "look", USES(past), USES(unseen));
    pass(g, "draw", NOTHING, USES(seen));
    graph_add_output(g, seen);
    compile(g);
    assert_order(g, "draw");
    assert_false(graph_has_history(g));
    assert_null(graph_get_image(g, past));
    graph_destroy(g, NULL);
}

static void a_cycle_is_named_pass_by_pass_in_the_flow_of_data(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c"), d = image(g, "d");
    pass(g, "tail", USES(c), USES(d)); // waits for the cycle, is not part of it
    pass(g, "march", USES(c), USES(a));
    pass(g, "bright", USES(a), USES(b));
    pass(g, "bloom", USES(b), USES(c));
    graph_add_output(g, d);
    assert_false(graph_compile(g, 64, 64));
    assert_error("cycle: march -> bright -> bloom -> march;");
    assert_int_equal(graph_order(g, NULL, 0), 0);
    graph_destroy(g, NULL);
}

static void a_pass_that_reads_what_it_writes_is_a_cycle(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a");
    pass(g, "blur", USES(a), USES(a));
    assert_false(graph_compile(g, 64, 64));
    assert_error("cycle: blur -> blur;");
    graph_destroy(g, NULL);
}

static void a_cycle_is_an_error_even_where_culling_would_hide_it(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), seen = image(g, "seen");
    pass(g, "x", USES(b), USES(a));
    pass(g, "y", USES(a), USES(b));
    pass(g, "draw", NOTHING, USES(seen));
    graph_add_output(g, seen);
    assert_false(graph_compile(g, 64, 64));
    assert_error("cycle: x -> y -> x;");
    graph_destroy(g, NULL);
}

static void an_image_has_one_writer(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "colour");
    pass(g, "march", NOTHING, USES(a));
    pass(g, "fog", NOTHING, USES(a));
    assert_false(graph_compile(g, 64, 64));
    assert_error("'colour'");
    assert_error("'march'");
    assert_error("'fog'");
    graph_destroy(g, NULL);
}

static void an_image_that_is_read_must_be_written(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "depth"), b = image(g, "b");
    pass(g, "march", USES(a), USES(b));
    assert_false(graph_compile(g, 64, 64));
    assert_error("'depth' is read by pass 'march' and never written");
    graph_destroy(g, NULL);

    g = graph_create();
    graph_image past = graph_add_history(g, image(g, "sum"));
    pass(g, "show", USES(past), USES(image(g, "b")));
    assert_false(graph_compile(g, 64, 64));
    assert_error("'sum history'");
    graph_destroy(g, NULL);

    g = graph_create();
    graph_add_output(g, image(g, "picture"));
    assert_false(graph_compile(g, 64, 64));
    assert_error("'picture' is an output and never written");
    graph_destroy(g, NULL);
}

static void names_are_unique(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a");
    assert_int_equal(
        graph_add_image(g, &(graph_image_desc){.name = "a", .format = GPU_R8, .scale = 1}).id, 0);
    assert_error("'a'");
    pass(g, "p", NOTHING, USES(a));
    assert_false(graph_add_pass(g, &(graph_pass_desc){.name = "p"}));
    assert_error("'p'");
    graph_destroy(g, NULL);
}

static void a_history_can_only_be_read_and_has_no_history(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), past = graph_add_history(g, a);
    assert_int_equal(graph_add_history(g, a).id, past.id);
    assert_int_equal(graph_add_history(g, past).id, 0);
    assert_error("'a history'");
    assert_false(
        graph_add_pass(g, &(graph_pass_desc){.name = "p", .writes = &past, .write_count = 1}));
    assert_error("can only be read");
    graph_destroy(g, NULL);
}

static void a_declaration_makes_the_compiled_order_stale(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a");
    pass(g, "p", NOTHING, USES(a));
    graph_add_output(g, a);
    compile(g);
    assert_order(g, "p");
    image(g, "b");
    assert_order(g, "");
    graph_destroy(g, NULL);
}

static void a_hundred_thousand_passes_compile(void **state) {
    (void)state;
    enum { COUNT = 100000 };
    graph *g = graph_create();
    graph_image *chain = calloc(COUNT, sizeof *chain);
    assert_non_null(chain);
    char name[32];
    for (int i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "image %d", i);
        chain[i] = image(g, name);
    }
    for (int i = COUNT - 1; i >= 0; i--) { // declared against the flow
        snprintf(name, sizeof name, "pass %d", i);
        pass(g, name, i ? USES(chain[i - 1]) : NOTHING, USES(chain[i]));
    }
    graph_add_output(g, chain[COUNT - 1]);
    compile(g);
    const char **names = calloc(COUNT, sizeof *names);
    assert_non_null(names);
    assert_int_equal(graph_order(g, names, COUNT), COUNT);
    assert_string_equal(names[0], "pass 0");
    assert_string_equal(names[COUNT - 1], "pass 99999");
    assert_int_equal(graph_find_image(g, "image 777").id, chain[777].id);
    assert_int_equal(graph_find_image(g, "image x").id, 0);
    assert_true(graph_shares_memory(g, chain[0], chain[2]));
    free(names);
    free(chain);
    graph_destroy(g, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_run_as_declared_when_nothing_says_otherwise),
        cmocka_unit_test(readers_run_after_writers_however_declared),
        cmocka_unit_test(an_early_pass_is_not_pushed_behind_a_late_one),
        cmocka_unit_test(passes_that_nobody_needs_are_culled),
        cmocka_unit_test(a_kept_pass_keeps_what_it_reads),
        cmocka_unit_test(a_graph_without_outputs_runs_nothing),
        cmocka_unit_test(reading_a_history_keeps_its_writer_and_makes_no_cycle),
        cmocka_unit_test(a_history_that_only_culled_passes_read_keeps_nothing),
        cmocka_unit_test(a_cycle_is_named_pass_by_pass_in_the_flow_of_data),
        cmocka_unit_test(a_pass_that_reads_what_it_writes_is_a_cycle),
        cmocka_unit_test(a_cycle_is_an_error_even_where_culling_would_hide_it),
        cmocka_unit_test(an_image_has_one_writer),
        cmocka_unit_test(an_image_that_is_read_must_be_written),
        cmocka_unit_test(names_are_unique),
        cmocka_unit_test(a_history_can_only_be_read_and_has_no_history),
        cmocka_unit_test(a_declaration_makes_the_compiled_order_stale),
        cmocka_unit_test(a_hundred_thousand_passes_compile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
