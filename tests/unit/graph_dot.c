// The Graphviz text of a graph.
#include "graph_fake_gpu.h"

static void assert_has(const strbuf *text, const char *part) {
    if (!strstr(strbuf_text(text), part)) fail_msg("'%s' is not in:\n%s", part, strbuf_text(text));
}

static void the_whole_graph_is_printed(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image sum = image(g, "sum");
    graph_image past = graph_add_history(g, sum);
    pass(g, "add", USES(past), USES(sum));
    graph_add_output(g, sum);
    compile(g);
    strbuf text = {0};
    graph_print_dot(g, "feedback", &text);
    assert_string_equal(strbuf_text(&text),
                        "digraph \"feedback\" {\n"
                        "  rankdir=LR;\n"
                        "  node [shape=ellipse, fontname=\"sans-serif\"];\n"
                        "  i0 [label=\"sum\\nrgba16f 640x360\", peripheries=2];\n"
                        "  i1 [label=\"sum history\\nrgba16f 640x360\"];\n"
                        "  i0 -> i1 [style=dashed, label=\"last frame\"];\n"
                        "  p0 [shape=box, label=\"add\"];\n"
                        "  i1 -> p0;\n"
                        "  p0 -> i0;\n"
                        "}\n");
    strbuf_free(&text);
    graph_destroy(g, NULL);
}

static void culled_passes_and_their_images_are_grey(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b");
    pass(g, "make", NOTHING, USES(a));
    pass(g, "debug", USES(a), USES(b));
    graph_add_output(g, a);
    compile(g);
    strbuf text = {0};
    graph_print_dot(g, "t", &text);
    assert_has(&text, "p0 [shape=box, label=\"make\"];");
    assert_has(&text, "p1 [shape=box, label=\"debug\", color=grey, fontcolor=grey];");
    assert_has(&text, "i1 [label=\"b\\nrgba16f 640x360\", color=grey, fontcolor=grey];");
    assert_has(&text, "i0 -> p1 [color=grey];");
    strbuf_free(&text);
    graph_destroy(g, NULL);
}

static void names_cannot_break_out_of_their_quotes(void **state) {
    (void)state;
    graph *g = graph_create();
    pass(g, "say \"hi\"\\\n", NOTHING, USES(image(g, "a\"];b")));
    strbuf text = {0};
    graph_print_dot(g, "my \"title\"", &text);
    assert_has(&text, "digraph \"my \\\"title\\\"\" {");
    assert_has(&text, "label=\"say \\\"hi\\\"\\\\ \"");
    assert_has(&text, "label=\"a\\\"];b\\n");
    strbuf_free(&text);
    graph_destroy(g, NULL);
}

static void a_graph_that_does_not_compile_can_be_printed(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a");
    pass(g, "blur", USES(a), USES(a));
    assert_false(graph_compile(g, 64, 64));
    strbuf text = {0};
    graph_print_dot(g, "t", &text);
    assert_has(&text, "i0 -> p0;");
    assert_has(&text, "p0 -> i0;");
    assert_null(strstr(strbuf_text(&text), "grey"));
    strbuf_free(&text);
    graph_destroy(g, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_whole_graph_is_printed),
        cmocka_unit_test(culled_passes_and_their_images_are_grey),
        cmocka_unit_test(names_cannot_break_out_of_their_quotes),
        cmocka_unit_test(a_graph_that_does_not_compile_can_be_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
