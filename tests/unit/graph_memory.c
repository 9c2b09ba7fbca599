// Sizes, lifetimes, and what allocation asks of the device.
#include "graph_fake_gpu.h"

static void end(graph *g, gpu *device) {
    graph_destroy(g, device);
    assert_int_equal(device->alive, 0);
    strbuf_free(&device->log);
}

static void assert_log(gpu *device, const char *expected) {
    assert_string_equal(strbuf_text(&device->log), expected);
    strbuf_free(&device->log);
}

static bool record_nothing(void *user, graph *g, gpu *device) {
    (void)user, (void)g, (void)device;
    return true;
}

static bool record_failure(void *user, graph *g, gpu *device) {
    (void)user, (void)g, (void)device;
    return err_set("no pipeline");
}

static void step(graph *g, const char *name, uses reads, uses writes) {
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = reads.at,
                                                     .read_count = 4,
                                                     .writes = writes.at,
                                                     .write_count = 4,
                                                     .record = record_nothing}));
}

static void allocate(graph *g, gpu *device) {
    if (!graph_allocate(g, device)) fail_msg("graph_allocate: %s", err_get());
}

// ---- sizes ------------------------------------------------------------------------------------

static void assert_size(float scale, uint32_t width, uint32_t height, uint32_t expected_width,
                        uint32_t expected_height) {
    graph *g = graph_create();
    graph_image a =
        graph_add_image(g, &(graph_image_desc){.name = "a", .format = GPU_R8, .scale = scale});
    assert_true(graph_compile(g, width, height));
    uint32_t size[3];
    graph_get_size(g, a, size);
    assert_int_equal(size[0], expected_width);
    assert_int_equal(size[1], expected_height);
    assert_int_equal(size[2], 1);
    graph_destroy(g, NULL);
}

static void relative_sizes_are_rounded_up(void **state) {
    (void)state;
    assert_size(1.0f, 1920, 1080, 1920, 1080);
    assert_size(0.25f, 1921, 1079, 481, 270);
    assert_size(0.5f, 1, 1, 1, 1);
    assert_size(0.1f, 1920, 1080, 192, 108); // 0.1f is above a tenth
    assert_size(1.0f / 3.0f, 1920, 16383, 640, 5461);
    assert_size(2.0f, 100, 50, 200, 100);
}

static void sizes_beyond_the_limit_are_errors(void **state) {
    (void)state;
    graph *g = graph_create();
    assert_false(graph_compile(g, 0, 100));
    assert_error("0 x 100");
    assert_false(graph_compile(g, 100, 16385));
    assert_error("16384");
    assert_true(graph_compile(g, 16384, 1));

    graph_add_image(g, &(graph_image_desc){.name = "big", .format = GPU_R8, .scale = 3});
    assert_false(graph_compile(g, 8192, 64));
    assert_error("'big' would be 24576 x 192 x 1");
    assert_false(graph_compile(g, 1, UINT32_MAX));
    graph_destroy(g, NULL);

    g = graph_create();
    graph_add_image(g, &(graph_image_desc){.name = "huge", .format = GPU_R8, .scale = 1e30f});
    assert_false(graph_compile(g, 64, 64));
    assert_error("'huge'");
    graph_destroy(g, NULL);
}

static void impossible_images_are_refused(void **state) {
    (void)state;
    static const struct {
        graph_image_desc desc;
        const char *message;
    } cases[] = {
        {{.name = "a", .scale = 1}, "no format"},
        {{.name = "a", .format = GPU_FORMAT_COUNT, .scale = 1}, "no format"},
        {{.name = "a", .format = GPU_R8}, "no size"},
        {{.name = "a", .format = GPU_R8, .width = 4}, "no size"},
        {{.name = "a", .format = GPU_R8, .scale = -1}, "above 0"},
        {{.name = "a", .format = GPU_R8, .scale = __builtin_nanf("")}, "above 0"},
        {{.name = "a", .format = GPU_R8, .scale = 1, .width = 4, .height = 4}, "one of them"},
        {{.name = "a", .format = GPU_RGBA8_SRGB, .scale = 1}, "rgba8"},
        {{.name = "a", .format = GPU_D32F, .width = 4, .height = 4, .depth = 4}, "2D"},
    };
    graph *g = graph_create();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(graph_add_image(g, &cases[i].desc).id, 0);
        assert_error(cases[i].message);
    }
    assert_int_equal(graph_images(g, NULL, 0), 0);
    graph_destroy(g, NULL);
}

static void mips_stop_at_one_texel_and_follow_a_resize(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image all = graph_add_image(
        g,
        &(graph_image_desc){.name = "all", .format = GPU_R8, .scale = 1, .mips = GRAPH_ALL_MIPS});
    graph_image six = graph_add_image(
        g, &(graph_image_desc){.name = "six", .format = GPU_R8, .scale = 1, .mips = 6});
    assert_true(graph_compile(g, 640, 360));
    assert_int_equal(graph_get_desc(g, all)->mips, 10);
    assert_int_equal(graph_get_desc(g, six)->mips, 6);
    assert_true(graph_compile(g, 8, 3));
    assert_int_equal(graph_get_desc(g, all)->mips, 4);
    assert_int_equal(graph_get_desc(g, six)->mips, 4);
    assert_true(graph_compile(g, 1024, 1));
    assert_int_equal(graph_get_desc(g, all)->mips, 11);
    assert_int_equal(graph_get_desc(g, six)->mips, 6);
    graph_destroy(g, NULL);
}

// ---- sharing ----------------------------------------------------------------------------------

static void a_chain_needs_two_images(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image at[5] = {image(g, "a"), image(g, "b"), image(g, "c"), image(g, "d"), image(g, "e")};
    step(g, "0", NOTHING, USES(at[0]));
    step(g, "1", USES(at[0]), USES(at[1]));
    step(g, "2", USES(at[1]), USES(at[2]));
    step(g, "3", USES(at[2]), USES(at[3]));
    step(g, "4", USES(at[3]), USES(at[4]));
    graph_add_output(g, at[4]);
    compile(g);
    assert_true(graph_shares_memory(g, at[0], at[2]));
    assert_true(graph_shares_memory(g, at[1], at[3]));
    assert_false(graph_shares_memory(g, at[0], at[1]));
    assert_false(graph_shares_memory(g, at[2], at[4])); // an output is on its own
    gpu device = {0};
    allocate(g, &device);
    assert_int_equal(device.created, 3);
    assert_ptr_equal(graph_get_image(g, at[0]), graph_get_image(g, at[2]));
    end(g, &device);
}

static void images_alive_together_do_not_share(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b"), c = image(g, "c"), d = image(g, "d");
    step(g, "0", NOTHING, USES(a));
    step(g, "1", USES(a), USES(b));
    step(g, "2", USES(b), USES(c));
    step(g, "3", USES(a, c), USES(d)); // a is still needed
    graph_add_output(g, d);
    compile(g);
    assert_false(graph_shares_memory(g, a, b));
    assert_false(graph_shares_memory(g, a, c));
    assert_false(graph_shares_memory(g, b, c)); // b is read while c is written
    graph_destroy(g, NULL);
}

static void an_image_that_nobody_reads_lives_for_its_pass(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), unread = image(g, "unread"), b = image(g, "b"),
                out = image(g, "out");
    step(g, "0", NOTHING, USES(a, unread));
    step(g, "1", USES(a), USES(b));
    step(g, "2", USES(b), USES(out));
    graph_add_output(g, out);
    compile(g);
    assert_false(graph_shares_memory(g, a, unread));
    assert_true(graph_shares_memory(g, unread, b));
    graph_destroy(g, NULL);
}

static graph_image image_of(graph *g, const char *name, gpu_format format, float scale,
                            uint32_t mips, bool target) {
    graph_image made = graph_add_image(
        g, &(graph_image_desc){
               .name = name, .format = format, .scale = scale, .mips = mips, .target = target});
    assert_int_not_equal(made.id, 0);
    return made;
}

static void only_images_of_one_kind_share(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image first = image_of(g, "first", GPU_RGBA16F, 0.5f, 1, false);
    graph_image others[] = {
        image_of(g, "format", GPU_RGBA32F, 0.5f, 1, false),
        image_of(g, "size", GPU_RGBA16F, 0.25f, 1, false),
        image_of(g, "mips", GPU_RGBA16F, 0.5f, 2, false),
        image_of(g, "target", GPU_RGBA16F, 0.5f, 1, true),
        graph_add_image(
            g,
            &(graph_image_desc){
                .name = "3D", .format = GPU_RGBA16F, .width = 320, .height = 180, .depth = 1}),
    };
    graph_image same = graph_add_image(
        g, &(graph_image_desc){.name = "same", .format = GPU_RGBA16F, .width = 320, .height = 180});
    pass_keeping(g, "0", NOTHING, USES(first), true);
    for (int i = 0; i < 5; i++) {
        char name[] = {'k', (char)('0' + i), 0};
        pass_keeping(g, name, NOTHING, USES(others[i]), true);
    }
    pass_keeping(g, "1", NOTHING, USES(same), true);
    compile(g);
    for (int i = 0; i < 5; i++) assert_false(graph_shares_memory(g, first, others[i]));
    assert_true(graph_shares_memory(g, first, same));
    graph_destroy(g, NULL);
}

static void culled_images_have_no_memory(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b");
    step(g, "0", NOTHING, USES(a));
    step(g, "1", USES(a), USES(b));
    graph_add_output(g, a);
    compile(g);
    gpu device = {0};
    allocate(g, &device);
    assert_int_equal(device.created, 1);
    assert_non_null(graph_get_image(g, a));
    assert_null(graph_get_image(g, b));
    assert_false(graph_shares_memory(g, a, b));
    assert_false(graph_shares_memory(g, b, b));
    end(g, &device);
}

static void optional_image_has_memory_while_it_is_read(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), out = image(g, "out");
    graph_image_desc desc = {.name = "more", .format = GPU_RGBA16F, .scale = 1, .optional = true};
    graph_image more = graph_add_image(g, &desc), past;
    step(g, "0", NOTHING, USES(a, more));
    step(g, "1", USES(a), USES(out));
    graph_add_output(g, out);
    compile(g);
    gpu device = {0};
    allocate(g, &device);
    assert_int_equal(device.alive, 2);
    assert_null(graph_get_image(g, more));
    assert_false(graph_is_alone(g, more));

    graph_add_output(g, more); // as an output
    compile(g);
    allocate(g, &device);
    assert_non_null(graph_get_image(g, more));
    graph_remove_output(g, more);
    compile(g);
    allocate(g, &device);
    assert_null(graph_get_image(g, more));

    past = graph_add_history(g, more); // or by a pass, and be it in the next frame
    pass_keeping(g, "2", USES(past), NOTHING, true);
    compile(g);
    assert_true(graph_allocate(g, &device));
    assert_non_null(graph_get_image(g, more));
    end(g, &device);
}

static void images_are_created_for_what_passes_do_with_them(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image stored = image_of(g, "stored", GPU_RGBA16F, 1, GRAPH_ALL_MIPS, false);
    graph_image drawn = image_of(g, "drawn", GPU_RGBA16F, 1, 1, true);
    graph_image depth = image_of(g, "depth", GPU_D32F, 1, 1, false);
    graph_image volume = graph_add_image(
        g, &(graph_image_desc){
               .name = "volume", .format = GPU_R16F, .width = 8, .height = 9, .depth = 10});
    pass_keeping(g, "p", NOTHING, USES(stored, drawn, depth, volume), true);
    compile(g);
    gpu device = {0};
    allocate(g, &device);
    const gpu_image_desc *d = gpu_image_get_desc(graph_get_image(g, stored));
    assert_int_equal(d->use, GPU_USE_SAMPLED | GPU_USE_STORAGE);
    assert_int_equal(d->width, 640);
    assert_int_equal(d->height, 360);
    assert_int_equal(d->depth, 0);
    assert_int_equal(d->mips, 10);
    d = gpu_image_get_desc(graph_get_image(g, drawn));
    assert_int_equal(d->use, GPU_USE_SAMPLED | GPU_USE_TARGET | GPU_USE_STORAGE);
    d = gpu_image_get_desc(graph_get_image(g, depth));
    assert_int_equal(d->use, GPU_USE_SAMPLED | GPU_USE_TARGET);
    assert_int_equal(d->format, GPU_D32F);
    d = gpu_image_get_desc(graph_get_image(g, volume));
    assert_int_equal(d->width, 8);
    assert_int_equal(d->height, 9);
    assert_int_equal(d->depth, 10);
    end(g, &device);
}

// ---- history ----------------------------------------------------------------------------------

typedef struct feedback {
    graph *g;
    graph_image sum, past, out;
} feedback;

// `sum` is made from its past; nothing of it shares memory.
static feedback feedback_create(const char *extra) {
    feedback f = {.g = graph_create()};
    f.sum = image(f.g, "sum");
    f.past = graph_add_history(f.g, f.sum);
    f.out = image(f.g, "out");
    step(f.g, "add", USES(f.past), USES(f.sum));
    graph_image between = f.sum;
    if (extra) {
        between = image(f.g, extra);
        step(f.g, extra, USES(f.sum), USES(between));
    }
    step(f.g, "show", USES(between), USES(f.out));
    graph_add_output(f.g, f.out);
    compile(f.g);
    return f;
}

static void a_graph_tells_whether_a_pass_reads_a_history(void **state) {
    (void)state;
    feedback f = feedback_create(NULL);
    assert_true(graph_has_history(f.g));
    graph_remove_output(f.g, f.out); // then nothing runs that does
    graph_image other = image(f.g, "other");
    step(f.g, "fill", NOTHING, USES(other));
    graph_add_output(f.g, other);
    compile(f.g);
    assert_false(graph_has_history(f.g));
    graph_destroy(f.g, NULL);
}

static void a_history_is_cleared_once_and_then_swapped(void **state) {
    (void)state;
    feedback f = feedback_create(NULL);
    gpu device = {0};
    allocate(f.g, &device);
    assert_int_equal(device.created, 3);
    assert_true(graph_execute(f.g, &device));
    assert_log(&device, "clear sum history;clear sum;begin add;end;begin show;end;");
    gpu_image *now = graph_get_image(f.g, f.sum), *past = graph_get_image(f.g, f.past);
    assert_ptr_not_equal(now, past);

    assert_true(graph_execute(f.g, &device));
    assert_log(&device, "begin add;end;begin show;end;");
    assert_ptr_equal(graph_get_image(f.g, f.past), now);
    assert_ptr_equal(graph_get_image(f.g, f.sum), past);
    end(f.g, &device);
}

static void compiling_again_at_the_same_size_keeps_all_memory(void **state) {
    (void)state;
    feedback f = feedback_create("blur");
    gpu device = {0};
    allocate(f.g, &device);
    assert_true(graph_execute(f.g, &device));
    strbuf_free(&device.log);
    gpu_image *now = graph_get_image(f.g, f.sum), *past = graph_get_image(f.g, f.past);
    uint64_t created = device.created;

    compile(f.g);
    compile(f.g); // twice without allocating between
    assert_null(graph_get_image(f.g, f.sum));
    allocate(f.g, &device);
    assert_int_equal(device.created, created);
    assert_int_equal(device.alive, created);
    assert_ptr_equal(graph_get_image(f.g, f.sum), now);
    assert_ptr_equal(graph_get_image(f.g, f.past), past);
    assert_true(graph_execute(f.g, &device));
    assert_null(strstr(strbuf_text(&device.log), "clear"));
    end(f.g, &device);
}

static void a_resize_clears_histories_and_keeps_fixed_images(void **state) {
    (void)state;
    feedback f = feedback_create(NULL);
    graph_image table = graph_add_image(
        f.g, &(graph_image_desc){.name = "table", .format = GPU_R16F, .width = 64, .height = 1});
    step(f.g, "bake", NOTHING, USES(table));
    graph_add_output(f.g, table);
    compile(f.g);
    gpu device = {0};
    allocate(f.g, &device);
    assert_true(graph_execute(f.g, &device));
    strbuf_free(&device.log);
    gpu_image *fixed = graph_get_image(f.g, table);
    assert_int_equal(device.created, 4);

    assert_true(graph_compile(f.g, 320, 200));
    allocate(f.g, &device);
    assert_int_equal(device.created, 7);
    assert_int_equal(device.alive, 4);
    assert_ptr_equal(graph_get_image(f.g, table), fixed);
    assert_true(graph_execute(f.g, &device));
    assert_non_null(strstr(strbuf_text(&device.log), "clear sum"));
    end(f.g, &device);
}

static void a_reset_clears_histories_once_more(void **state) {
    (void)state;
    feedback f = feedback_create(NULL);
    gpu device = {0};
    allocate(f.g, &device);
    assert_true(graph_execute(f.g, &device));
    graph_reset_history(f.g);
    strbuf_free(&device.log);
    assert_true(graph_execute(f.g, &device));
    assert_non_null(strstr(strbuf_text(&device.log), "clear sum"));
    strbuf_free(&device.log);
    assert_true(graph_execute(f.g, &device));
    assert_log(&device, "begin add;end;begin show;end;");

    graph_reset_history(f.g); // is not forgotten by compiling
    compile(f.g);
    allocate(f.g, &device);
    assert_true(graph_execute(f.g, &device));
    assert_non_null(strstr(strbuf_text(&device.log), "clear sum"));
    end(f.g, &device);
}

static void memory_of_a_plain_image_never_becomes_a_past(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image sum = image(g, "sum"), out = image(g, "out");
    graph_image past = graph_add_history(g, sum);
    step(g, "add", USES(past), USES(sum));
    graph_add_output(g, sum);
    step(g, "show", USES(past), USES(out));
    gpu device = {0};
    compile(g);
    allocate(g, &device);
    assert_true(graph_execute(g, &device));
    strbuf_free(&device.log);

    feedback plain = {.g = graph_create()}; // same names, but `sum` has no past
    plain.sum = image(plain.g, "sum");
    step(plain.g, "add", NOTHING, USES(plain.sum));
    graph_add_output(plain.g, plain.sum);
    compile(plain.g);
    allocate(plain.g, &device);
    gpu_image *memory = graph_get_image(plain.g, plain.sum);
    graph_adopt(g, plain.g);
    assert_ptr_equal(graph_get_image(plain.g, plain.sum), memory);

    graph_image wanted = image(plain.g, "wanted"); // now its past is read
    step(plain.g, "echo", USES(graph_add_history(plain.g, plain.sum)), USES(wanted));
    graph_add_output(plain.g, wanted);
    compile(plain.g);
    allocate(plain.g, &device);
    assert_true(graph_execute(plain.g, &device));
    assert_log(&device, "clear sum history;clear sum;begin add;end;begin echo;end;");
    graph_destroy(plain.g, &device);
    end(g, &device);
}

static void adoption(bool allocate_first) {
    gpu device = {0};
    feedback old = feedback_create(NULL), fresh = feedback_create("blur");
    allocate(old.g, &device);
    assert_true(graph_execute(old.g, &device));
    gpu_image *now = graph_get_image(old.g, old.sum), *past = graph_get_image(old.g, old.past);
    if (allocate_first) allocate(fresh.g, &device);
    graph_adopt(fresh.g, old.g);
    if (!allocate_first) allocate(fresh.g, &device);
    assert_ptr_equal(graph_get_image(fresh.g, fresh.sum), now);
    assert_ptr_equal(graph_get_image(fresh.g, fresh.past), past);
    graph_destroy(old.g, &device);
    strbuf_free(&device.log);
    assert_true(graph_execute(fresh.g, &device));
    assert_null(strstr(strbuf_text(&device.log), "clear"));
    assert_ptr_equal(graph_get_image(fresh.g, fresh.past), now);
    end(fresh.g, &device);
}

static void a_new_graph_adopts_the_past_of_an_old_one(void **state) {
    (void)state;
    adoption(true);
    adoption(false);
}

static void a_past_of_another_size_is_not_adopted(void **state) {
    (void)state;
    gpu device = {0};
    feedback old = feedback_create(NULL), fresh = feedback_create(NULL);
    allocate(old.g, &device);
    assert_true(graph_execute(old.g, &device));
    assert_true(graph_compile(fresh.g, 32, 32));
    graph_adopt(fresh.g, old.g);
    allocate(fresh.g, &device);
    assert_non_null(graph_get_image(old.g, old.sum));
    strbuf_free(&device.log);
    assert_true(graph_execute(fresh.g, &device));
    assert_non_null(strstr(strbuf_text(&device.log), "clear sum"));
    graph_destroy(old.g, &device);
    end(fresh.g, &device);
}

static void adoption_is_undone_by_the_other_way_round(void **state) {
    (void)state;
    gpu device = {0};
    feedback old = feedback_create(NULL), fresh = feedback_create("blur");
    allocate(old.g, &device);
    assert_true(graph_execute(old.g, &device));
    gpu_image *now = graph_get_image(old.g, old.sum), *past = graph_get_image(old.g, old.past);
    graph_adopt(fresh.g, old.g);
    assert_null(graph_get_image(old.g, old.sum));
    device.fail_at = device.created + 1; // of what only `fresh` has
    assert_false(graph_allocate(fresh.g, &device));
    graph_adopt(fresh.g, old.g);
    graph_destroy(fresh.g, &device);
    assert_ptr_equal(graph_get_image(old.g, old.sum), now);
    assert_ptr_equal(graph_get_image(old.g, old.past), past);
    strbuf_free(&device.log);
    assert_true(graph_execute(old.g, &device)); // it needs no allocation
    assert_null(strstr(strbuf_text(&device.log), "clear"));
    end(old.g, &device);
}

// ---- failures ---------------------------------------------------------------------------------

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state) {
    (void)state;
    for (uint64_t n = 1; n <= 4; n++) {
        feedback f = feedback_create("blur");
        gpu device = {.fail_at = n};
        assert_false(graph_allocate(f.g, &device));
        assert_error("image '");
        assert_error("no device memory");
        allocate(f.g, &device); // what was made is used
        assert_int_equal(device.alive, 4);
        assert_int_equal(device.created, 5);
        assert_true(graph_execute(f.g, &device));
        end(f.g, &device);
    }
}

static void a_failing_pass_is_named_and_ends_the_execution(void **state) {
    (void)state;
    graph *g = graph_create();
    graph_image a = image(g, "a"), b = image(g, "b");
    assert_true(graph_add_pass(
        g, &(graph_pass_desc){
               .name = "broken", .writes = &a, .write_count = 1, .record = record_failure}));
    step(g, "after", USES(a), USES(b));
    graph_add_output(g, b);
    compile(g);
    gpu device = {0};
    allocate(g, &device);
    assert_false(graph_execute(g, &device));
    assert_error("pass 'broken': no pipeline");
    assert_log(&device, "begin broken;end;");
    end(g, &device);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relative_sizes_are_rounded_up),
        cmocka_unit_test(sizes_beyond_the_limit_are_errors),
        cmocka_unit_test(impossible_images_are_refused),
        cmocka_unit_test(mips_stop_at_one_texel_and_follow_a_resize),
        cmocka_unit_test(a_chain_needs_two_images),
        cmocka_unit_test(images_alive_together_do_not_share),
        cmocka_unit_test(an_image_that_nobody_reads_lives_for_its_pass),
        cmocka_unit_test(only_images_of_one_kind_share),
        cmocka_unit_test(culled_images_have_no_memory),
        cmocka_unit_test(optional_image_has_memory_while_it_is_read),
        cmocka_unit_test(images_are_created_for_what_passes_do_with_them),
        cmocka_unit_test(a_graph_tells_whether_a_pass_reads_a_history),
        cmocka_unit_test(a_history_is_cleared_once_and_then_swapped),
        cmocka_unit_test(compiling_again_at_the_same_size_keeps_all_memory),
        cmocka_unit_test(a_resize_clears_histories_and_keeps_fixed_images),
        cmocka_unit_test(a_reset_clears_histories_once_more),
        cmocka_unit_test(memory_of_a_plain_image_never_becomes_a_past),
        cmocka_unit_test(a_new_graph_adopts_the_past_of_an_old_one),
        cmocka_unit_test(a_past_of_another_size_is_not_adopted),
        cmocka_unit_test(adoption_is_undone_by_the_other_way_round),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
        cmocka_unit_test(a_failing_pass_is_named_and_ends_the_execution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
