// Images that keep their content: what their writer can rely on when it writes nothing.
#include "graph_fake_gpu.h"

typedef struct table {
    graph *g;
    graph_image table, out;
    bool had; // what the writer found in the last execution
} table;

static bool record_table(void *user, graph *g, gpu *device) {
    (void)device;
    table *t = user;
    t->had = graph_has_content(g, t->table);
    return true;
}

static bool record_nothing(void *user, graph *g, gpu *device) {
    (void)user, (void)g, (void)device;
    return true;
}

static void step(graph *g, const char *name, graph_image read, graph_image write) {
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = &read,
                                                     .read_count = 1,
                                                     .writes = &write,
                                                     .write_count = 1,
                                                     .record = record_nothing}));
}

// A table that is kept, then a chain of images of the same kind that could use its memory.
static void open_table(table *t) {
    *t = (table){.g = graph_create()};
    t->table = graph_add_image(
        t->g, &(graph_image_desc){
                  .name = "table", .format = GPU_R16F, .width = 8, .height = 8, .keep = true});
    graph_image_desc other = {.name = "a", .format = GPU_R16F, .width = 8, .height = 8};
    graph_image a = graph_add_image(t->g, &other);
    other.name = "b";
    graph_image b = graph_add_image(t->g, &other);
    t->out = image(t->g, "out");
    assert_true(graph_add_pass(t->g, &(graph_pass_desc){.name = "table",
                                                        .writes = &t->table,
                                                        .write_count = 1,
                                                        .record = record_table,
                                                        .user = t}));
    step(t->g, "a", t->table, a);
    step(t->g, "b", a, b);
    step(t->g, "out", b, t->out);
    graph_add_output(t->g, t->out);
    compile(t->g);
    assert_true(graph_is_alone(t->g, t->table));
    assert_false(graph_shares_memory(t->g, t->table, b));
}

static bool finds_content(table *t, gpu *device) {
    assert_true(graph_allocate(t->g, device) && graph_execute(t->g, device));
    return t->had;
}

static void close_table(table *t, gpu *device) {
    graph_destroy(t->g, device);
    strbuf_free(&device->log);
}

static void content_stays_from_execution_to_execution(void **state) {
    (void)state;
    table t;
    gpu device = {0};
    open_table(&t);
    assert_false(finds_content(&t, &device));
    assert_true(finds_content(&t, &device));
    graph_reset_history(t.g); // it is no history
    assert_true(finds_content(&t, &device));
    assert_true(graph_compile(t.g, 320, 200)); // its size is fixed
    assert_true(finds_content(&t, &device));
    close_table(&t, &device);
}

static void memory_made_anew_has_no_content(void **state) {
    (void)state;
    table t;
    gpu device = {0};
    open_table(&t);
    assert_false(finds_content(&t, &device));
    graph_remove_output(t.g, t.out);
    assert_true(graph_compile(t.g, 64, 64)); // culled, so its memory goes
    assert_true(graph_allocate(t.g, &device));
    assert_int_equal(device.alive, 0);
    graph_add_output(t.g, t.out);
    compile(t.g);
    assert_false(finds_content(&t, &device));
    close_table(&t, &device);
}

static void adopted_memory_has_the_content_of_the_other_graph(void **state) {
    (void)state;
    table old, fresh;
    gpu device = {0};
    open_table(&old);
    open_table(&fresh);
    assert_false(finds_content(&old, &device));
    graph_adopt(fresh.g, old.g);
    graph_adopt(fresh.g, old.g); // undone: `old` goes on
    assert_true(finds_content(&old, &device));
    graph_adopt(fresh.g, old.g);
    assert_true(finds_content(&fresh, &device));
    close_table(&old, &device);
    close_table(&fresh, &device);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(content_stays_from_execution_to_execution),
        cmocka_unit_test(memory_made_anew_has_no_content),
        cmocka_unit_test(adopted_memory_has_the_content_of_the_other_graph),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
