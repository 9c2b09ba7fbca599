// What a pass takes from another one arrives in its picture.
#include "pass_test.h"

enum { SIZE = 24, VALUES = SIZE * SIZE * 4 };

static bool swing(void *user, int function, double time, float out[4]) {
    (void)user, (void)function;
    for (int i = 0; i < 4; i++) out[i] = 1 + (float)time;
    return true;
}

static pass *add_slice(pass_world *w, const char *label) {
    return world_add(w, NULL, "slice.comp", label);
}

static bool same_pictures(pass_world *w, const pass *a, const pass *b) {
    float *one = world_read(w, pass_output(a, "color"));
    float *other = world_read(w, pass_output(b, "color"));
    bool same = memcmp(one, other, VALUES * sizeof *one) == 0;
    mem_free(one);
    mem_free(other);
    return same;
}

static void fields_and_moving_numbers_are_those_of_the_source(void **state) {
    pass_world w;
    world_open(&w, *state);
    w.context = (field_context){.call = swing};
    pass *a = add_slice(&w, "a"), *b = add_slice(&w, "b"), *c = add_slice(&w, "c");
    gpu_test_ok(pass_set_field(a, "value", block(&w, 1, 0.5f)));
    gpu_test_ok(pass_set_field(a, "tint", triple(&w, 1, 0.5f, 0.25f)));
    gpu_test_ok(pass_set_uniform(a, "half_width", field_call(&w.memory, 1, 1)) && pass_declare(a));
    pass_add_source(b, a);
    gpu_test_ok(pass_declare(b));
    pass_add_source(c, b); // along the chain, but for one number
    gpu_test_ok(pass_set_uniform(c, "half_width", number(&w, 2)) && pass_declare(c));
    graph_add_output(w.host.graph, pass_output(a, "color"));
    graph_add_output(w.host.graph, pass_output(b, "color"));
    world_render(&w, SIZE, SIZE, pass_output(c, "color"));
    assert_true(same_pictures(&w, a, b) && !same_pictures(&w, a, c));
    w.context.time = 1; // now a is as wide as c
    world_frame(&w, SIZE, SIZE, 2);
    assert_true(same_pictures(&w, a, b) && same_pictures(&w, a, c));
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_and_moving_numbers_are_those_of_the_source),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
