// Graphs on a device: histories, shared memory, and the same bits every time.
#include "gpu/gpu_test.h"
#include "gpu/graph_shaders.h"
#include "graph/graph.h"
#include <string.h>

enum { WIDTH = 64, HEIGHT = 48, TEXELS = WIDTH * HEIGHT };

static const gpu_slot slots[] = {
    {.binding = 0, .kind = GPU_SLOT_UNIFORM, .reads = true},
    {.binding = 1, .kind = GPU_SLOT_STORAGE_IMAGE, .reads = true},
    {.binding = 2, .kind = GPU_SLOT_STORAGE_IMAGE, .writes = true},
};

typedef struct spread { // one pass: result = keep * source + bleed * neighbour + add * (1 + x)
    gpu_pipeline *pipeline;
    graph_image source, result;
    gpu_image *fixed; // read where there is no `source`
    float amounts[3]; // keep, bleed, add
} spread;

static gpu *device;
static gpu_pipeline *pipeline;

static int open_device(void **state) {
    (void)state;
    device = gpu_test_open(NULL);
    pipeline =
        gpu_pipeline_create_compute(device, &(gpu_compute_desc){.label = "spread",
                                                                .code = spread_code,
                                                                .code_size = sizeof spread_code,
                                                                .slots = slots,
                                                                .slot_count = COUNT_OF(slots),
                                                                .local_size = {8, 8, 1}});
    gpu_test_ok(pipeline);
    return 0;
}

static int close_device(void **state) {
    (void)state;
    gpu_pipeline_destroy(device, pipeline);
    gpu_test_close(device);
    return 0;
}

static bool record_spread(void *user, graph *g, gpu *on) {
    const spread *s = user;
    gpu_image *source = s->source.id ? graph_get_image(g, s->source) : s->fixed;
    gpu_image *result = graph_get_image(g, s->result);
    const gpu_image_desc *size = gpu_image_get_desc(result);
    const gpu_binding bindings[] = {
        {.binding = 0, .uniform = s->amounts, .uniform_size = sizeof s->amounts},
        {.binding = 1, .image = source},
        {.binding = 2, .image = result},
    };
    return gpu_dispatch(on, &(gpu_dispatch_desc){.pipeline = s->pipeline,
                                                 .bindings = bindings,
                                                 .binding_count = 3,
                                                 .threads = {size->width, size->height, 1}});
}

static graph_image image(graph *g, const char *name) {
    graph_image made =
        graph_add_image(g, &(graph_image_desc){.name = name, .format = GPU_R32F, .scale = 1});
    assert_int_not_equal(made.id, 0);
    return made;
}

static void pass(graph *g, const char *name, spread *s) {
    s->pipeline = pipeline;
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = &s->source,
                                                     .read_count = 1,
                                                     .writes = &s->result,
                                                     .write_count = 1,
                                                     .record = record_spread,
                                                     .user = s}));
}

static void ready(graph *g, uint32_t width, uint32_t height) {
    gpu_test_ok(graph_compile(g, width, height));
    gpu_test_ok(graph_allocate(g, device));
}

static void execute(graph *g) {
    gpu_test_ok(gpu_frame_begin(device) != 0);
    gpu_test_ok(graph_execute(g, device));
    gpu_test_ok(gpu_frame_end(device));
}

static float *read_image(const graph *g, graph_image from) {
    gpu_image *read = graph_get_image(g, from);
    assert_non_null(read);
    const gpu_image_desc *d = gpu_image_get_desc(read);
    size_t size = (size_t)d->width * d->height * sizeof(float);
    float *out = mem_alloc(size);
    gpu_test_ok(gpu_image_read(device, read, out, size));
    return out;
}

// Every texel of column x is (1 + x) * expected.
static void assert_ramp(const graph *g, graph_image of, float expected) {
    uint32_t size[3];
    graph_get_size(g, of, size);
    float *texels = read_image(g, of);
    for (uint32_t y = 0; y < size[1]; y++)
        for (uint32_t x = 0; x < size[0]; x++) {
            float got = texels[y * size[0] + x], wanted = expected * (float)(1 + x);
            if (got != wanted)
                fail_msg("texel %u, %u is %g, not %g", x, y, (double)got, (double)wanted);
        }
    mem_free(texels);
}

// ---- history ----------------------------------------------------------------------------------

typedef struct counter { // sum = past + frame
    graph *g;
    graph_image sum, past;
    spread add;
} counter;

static void counter_create(counter *c) {
    *c = (counter){.g = graph_create()};
    c->sum = image(c->g, "sum");
    c->past = graph_add_history(c->g, c->sum);
    c->add = (spread){.source = c->past, .result = c->sum, .amounts = {1, 0, 0}};
    pass(c->g, "add", &c->add);
    graph_add_output(c->g, c->sum);
    ready(c->g, WIDTH, HEIGHT);
}

static void counter_run(counter *c, int first, int last) {
    for (int frame = first; frame <= last; frame++) {
        c->add.amounts[2] = (float)frame;
        execute(c->g);
    }
}

static void a_history_accumulates_frame_numbers(void **state) {
    (void)state;
    counter c;
    counter_create(&c);
    counter_run(&c, 1, 1);
    assert_ramp(c.g, c.sum, 1);
    assert_ramp(c.g, c.past, 0); // all zero in the first frame
    counter_run(&c, 2, 10);
    assert_ramp(c.g, c.sum, 55);
    assert_ramp(c.g, c.past, 45);
    graph_destroy(c.g, device);
}

static void compiling_again_keeps_a_history_and_a_resize_clears_it(void **state) {
    (void)state;
    counter c;
    counter_create(&c);
    counter_run(&c, 1, 4);
    ready(c.g, WIDTH, HEIGHT);
    assert_ramp(c.g, c.sum, 10);
    counter_run(&c, 5, 5);
    assert_ramp(c.g, c.sum, 15);

    ready(c.g, 33, 17);
    counter_run(&c, 7, 8);
    assert_ramp(c.g, c.sum, 15);
    assert_ramp(c.g, c.past, 7);

    graph_reset_history(c.g);
    counter_run(&c, 9, 9);
    assert_ramp(c.g, c.sum, 9);
    assert_ramp(c.g, c.past, 0);
    graph_destroy(c.g, device);
}

static void a_new_graph_goes_on_where_the_old_one_was(void **state) {
    (void)state;
    counter old, fresh;
    counter_create(&old);
    counter_create(&fresh);
    counter_run(&old, 1, 6);
    graph_adopt(fresh.g, old.g);
    graph_destroy(old.g, device);
    counter_run(&fresh, 7, 10);
    assert_ramp(fresh.g, fresh.sum, 55);
    graph_destroy(fresh.g, device);
}

// ---- shared memory ----------------------------------------------------------------------------

enum { CHAIN = 12, FRAMES = 5 };

// A chain of passes that each read neighbours, started from a picture, its last image fed back.
// With `share` false every image is an output, so that none shares memory.
static float *run_chain(bool share, size_t *memory) {
    gpu_image *start = gpu_image_create(device, &(gpu_image_desc){.label = "start",
                                                                  .format = GPU_R32F,
                                                                  .width = WIDTH,
                                                                  .height = HEIGHT,
                                                                  .use = GPU_USE_STORAGE});
    assert_non_null(start);
    float *texels = mem_alloc(TEXELS * sizeof *texels);
    for (size_t i = 0; i < TEXELS; i++) texels[i] = (float)((i * 7919) % 1009) / 1009.0f;
    gpu_test_ok(gpu_image_write(device, start, 0, texels, TEXELS * sizeof *texels));
    mem_free(texels);

    graph *g = graph_create();
    spread steps[CHAIN];
    graph_image last = {0};
    for (int i = 0; i < CHAIN; i++) {
        char name[16];
        snprintf(name, sizeof name, "step %d", i);
        steps[i] = (spread){.source = last,
                            .result = image(g, name),
                            .fixed = start,
                            .amounts = {0.7f, 0.2f + 0.01f * (float)i, 0.001f}};
        last = steps[i].result;
        pass(g, name, &steps[i]);
        if (!share) graph_add_output(g, last);
    }
    graph_image sum = image(g, "sum"), past = graph_add_history(g, sum), mixed = image(g, "mixed");
    spread keep = {.source = last, .result = sum, .amounts = {1, 0, 0}};
    spread feed = {.source = past, .result = mixed, .amounts = {0.5f, 0.25f, 0.125f}};
    pass(g, "keep", &keep);
    pass(g, "feed", &feed);
    graph_add_output(g, last);
    graph_add_output(g, mixed);
    ready(g, WIDTH, HEIGHT);
    *memory = 0;
    for (int i = 0; i + 2 < CHAIN; i++)
        *memory += graph_shares_memory(g, steps[i].result, steps[i + 2].result);

    for (int i = 0; i < FRAMES; i++) execute(g);
    float *pictures = mem_alloc(2 * TEXELS * sizeof *pictures);
    float *first = read_image(g, last), *second = read_image(g, mixed);
    memcpy(pictures, first, TEXELS * sizeof *first);
    memcpy(pictures + TEXELS, second, TEXELS * sizeof *second);
    mem_free(first);
    mem_free(second);
    graph_destroy(g, device);
    gpu_image_destroy(device, start);
    return pictures;
}

static void sharing_memory_changes_no_bit(void **state) {
    (void)state;
    size_t sharing, alone;
    float *a = run_chain(true, &sharing), *b = run_chain(false, &alone);
    assert_int_equal(sharing, CHAIN - 3); // all but the last image, which is an output
    assert_int_equal(alone, 0);
    assert_memory_equal(a, b, 2 * TEXELS * sizeof *a);
    assert_memory_not_equal(a, a + TEXELS, TEXELS * sizeof *a);
    for (size_t i = 0; i < 2 * TEXELS; i++) assert_true(a[i] > 0 && a[i] < 100);
    mem_free(a);
    mem_free(b);
}

static void two_runs_give_the_same_bits(void **state) {
    (void)state;
    size_t sharing;
    float *a = run_chain(true, &sharing), *b = run_chain(true, &sharing);
    assert_memory_equal(a, b, 2 * TEXELS * sizeof *a);
    mem_free(a);
    mem_free(b);
}

static void passes_are_timed_under_their_names(void **state) {
    (void)state;
    counter c;
    counter_create(&c);
    uint64_t frame = gpu_frame_begin(device);
    gpu_test_ok(frame != 0);
    gpu_test_ok(graph_execute(c.g, device));
    gpu_test_ok(gpu_frame_end(device));
    gpu_pass_time times[4];
    if (gpu_get_info(device)->timestamp_period > 0) {
        assert_int_equal(gpu_frame_times(device, frame, times, 4), 1);
        assert_string_equal(times[0].label, "add");
    }
    graph_destroy(c.g, device);
}

// A test and not part of closing the device: cmocka's result leaves out what fails there.
static void validation_has_nothing_to_say(void **state) {
    (void)state;
    gpu_test_ok(gpu_idle(device));
    assert_int_equal(gpu_validation_messages(device), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_history_accumulates_frame_numbers),
        cmocka_unit_test(compiling_again_keeps_a_history_and_a_resize_clears_it),
        cmocka_unit_test(a_new_graph_goes_on_where_the_old_one_was),
        cmocka_unit_test(sharing_memory_changes_no_bit),
        cmocka_unit_test(two_runs_give_the_same_bits),
        cmocka_unit_test(passes_are_timed_under_their_names),
        cmocka_unit_test(validation_has_nothing_to_say),
    };
    gpu_test_need_device();
    return cmocka_run_group_tests(tests, open_device, close_device);
}
