// Compute work end to end: uniforms, 2D and 3D images, levels, buffers, read back.
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <string.h>

typedef struct ramp_params {
    float scale, offset;
} ramp_params;

static gpu_pipeline *make_ramp(gpu *g) {
    const gpu_slot slots[] = {{.binding = 0, .kind = GPU_SLOT_UNIFORM},
                              {.binding = 1, .kind = GPU_SLOT_STORAGE_IMAGE, .writes = true}};
    gpu_pipeline *pipeline =
        gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "ramp",
                                                           .code = ramp_comp_code,
                                                           .code_size = sizeof ramp_comp_code,
                                                           .slots = slots,
                                                           .slot_count = COUNT_OF(slots),
                                                           .local_size = {8, 8, 1}});
    gpu_test_ok(pipeline);
    return pipeline;
}

static gpu_image *make_image(gpu *g, gpu_format format, uint32_t width, uint32_t height,
                             uint32_t depth, uint32_t mips) {
    gpu_image *image =
        gpu_image_create(g, &(gpu_image_desc){.label = "picture",
                                              .format = format,
                                              .width = width,
                                              .height = height,
                                              .depth = depth,
                                              .mips = mips,
                                              .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    gpu_test_ok(image);
    return image;
}

static void ramp(gpu *g, gpu_pipeline *pipeline, gpu_image *image, float scale, float offset) {
    ramp_params params = {scale, offset};
    const gpu_image_desc *d = gpu_image_get_desc(image);
    const gpu_binding bindings[] = {
        {.binding = 0, .uniform = &params, .uniform_size = sizeof params},
        {.binding = 1, .image = image}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {d->width, d->height, 1}}));
}

static void dispatch_writes_every_texel(void **state) {
    gpu *g = *state;
    enum { W = 37, H = 21 };
    gpu_pipeline *pipeline = make_ramp(g);
    gpu_image *image = make_image(g, GPU_R32F, W, H, 0, 1);
    float texels[W * H];
    gpu_test_ok(gpu_frame_begin(g));
    ramp(g, pipeline, image, 2.0f, 0.5f);
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_image_read(g, image, texels, sizeof texels));
    for (int i = 0; i < W * H; i++) assert_true(texels[i] == 2.0f * (float)i + 0.5f);
    gpu_image_destroy(g, image);
    gpu_pipeline_destroy(g, pipeline);
}

static void volume_is_sampled_and_stored(void **state) {
    gpu *g = *state;
    enum { N = 6 };
    const gpu_slot slots[] = {{.binding = 0, .kind = GPU_SLOT_SAMPLED_IMAGE},
                              {.binding = 1, .kind = GPU_SLOT_STORAGE_IMAGE, .writes = true}};
    gpu_pipeline *pipeline =
        gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "volume",
                                                           .code = volume_comp_code,
                                                           .code_size = sizeof volume_comp_code,
                                                           .slots = slots,
                                                           .slot_count = COUNT_OF(slots),
                                                           .local_size = {4, 4, 4}});
    gpu_test_ok(pipeline);
    gpu_image *from = make_image(g, GPU_RGBA32F, N, N, N, 1);
    gpu_image *to = make_image(g, GPU_RGBA16F, N, N, N, 1);
    float in[N * N * N][4];
    uint16_t out[N * N * N][4];
    for (int i = 0; i < N * N * N * 4; i++) in[i / 4][i % 4] = (float)(i % 3);
    gpu_test_ok(gpu_image_write(g, from, 0, in, sizeof in));
    gpu_test_ok(gpu_frame_begin(g));
    const gpu_binding bindings[] = {{.binding = 0, .image = from, .sampler = GPU_NEAREST_CLAMP},
                                    {.binding = 1, .image = to}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {N, N, N}}));
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_image_read(g, to, out, sizeof out));
    static const uint16_t halves[3] = {0x0000, 0x4000, 0x4400}; // 0, 2, 4
    for (int i = 0; i < N * N * N * 4; i++) assert_int_equal(out[i / 4][i % 4], halves[i % 3]);
    gpu_image_destroy(g, from);
    gpu_image_destroy(g, to);
    gpu_pipeline_destroy(g, pipeline);
}

static void halve(gpu *g, gpu_pipeline *pipeline, gpu_image *image, uint32_t mip, uint32_t size) {
    const gpu_binding bindings[] = {
        {.binding = 0, .image = image, .mip = mip, .one_mip = true, .sampler = GPU_NEAREST_CLAMP},
        {.binding = 1, .image = image, .mip = mip + 1}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {size, size, 1}}));
}

static gpu_pipeline *make_halve(gpu *g) {
    const gpu_slot slots[] = {{.binding = 0, .kind = GPU_SLOT_SAMPLED_IMAGE},
                              {.binding = 1, .kind = GPU_SLOT_STORAGE_IMAGE, .writes = true}};
    gpu_pipeline *pipeline =
        gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "halve",
                                                           .code = halve_comp_code,
                                                           .code_size = sizeof halve_comp_code,
                                                           .slots = slots,
                                                           .slot_count = COUNT_OF(slots),
                                                           .local_size = {8, 8, 1}});
    gpu_test_ok(pipeline);
    return pipeline;
}

static void each_level_follows_from_the_one_above(void **state) {
    gpu *g = *state;
    enum { N = 16 };
    gpu_pipeline *ramp_pipeline = make_ramp(g), *halve_pipeline = make_halve(g);
    gpu_image *image = make_image(g, GPU_R32F, N, N, 0, 5);
    gpu_image *last = make_image(g, GPU_R32F, 2, 1, 0, 1);
    gpu_test_ok(gpu_frame_begin(g));
    for (int round = 0; round < 2; round++) { // the second round meets levels already in use
        ramp(g, ramp_pipeline, image, 1.0f, 3.0f);
        for (uint32_t mip = 0; mip < 4; mip++) {
            halve(g, halve_pipeline, image, mip, (uint32_t)N >> (mip + 1));
        }
    }
    // Reads a level in one dispatch that the chain wrote: level 3 is 2x2, its mean is level 4.
    const gpu_binding bindings[] = {
        {.binding = 0, .image = image, .mip = 3, .one_mip = true, .sampler = GPU_NEAREST_CLAMP},
        {.binding = 1, .image = last}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = halve_pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings)}));
    gpu_test_ok(gpu_frame_end(g));
    float out[2];
    gpu_test_ok(gpu_image_read(g, last, out, sizeof out));
    assert_true(out[0] == (float)(N * N - 1) * 0.5f + 3.0f);
    gpu_image_destroy(g, image);
    gpu_image_destroy(g, last);
    gpu_pipeline_destroy(g, ramp_pipeline);
    gpu_pipeline_destroy(g, halve_pipeline);
}

// The shader reads the first three; the rest fills the ring of uniforms.
typedef struct step_params {
    uint32_t factor, add, count, unused[253];
} step_params;

static gpu_pipeline *make_step(gpu *g) {
    const gpu_slot slots[] = {
        {.binding = 0, .kind = GPU_SLOT_UNIFORM},
        {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    gpu_pipeline *pipeline =
        gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "step",
                                                           .code = step_comp_code,
                                                           .code_size = sizeof step_comp_code,
                                                           .slots = slots,
                                                           .slot_count = COUNT_OF(slots),
                                                           .local_size = {64, 1, 1}});
    gpu_test_ok(pipeline);
    return pipeline;
}

static void step(gpu *g, gpu_pipeline *pipeline, gpu_buffer *buffer, step_params params) {
    const gpu_binding bindings[] = {
        {.binding = 0, .uniform = &params, .uniform_size = sizeof params},
        {.binding = 1, .buffer = buffer}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {params.count, 1, 1}}));
}

// Steps one after the other, each by what the one before left; the same `frames` times.
static void count_in_frames(gpu *g, uint32_t steps, uint32_t frames) {
    enum { COUNT = 100 };
    gpu_pipeline *pipeline = make_step(g);
    gpu_buffer *buffer = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "counts", .size = COUNT * sizeof(uint32_t)});
    gpu_test_ok(buffer);
    uint32_t expected[COUNT], found[COUNT];
    for (uint32_t frame = 0; frame < frames; frame++) {
        gpu_test_ok(gpu_frame_begin(g));
        gpu_buffer_fill(g, buffer, 7);
        for (uint32_t i = 0; i < steps; i++) {
            step(g, pipeline, buffer, (step_params){i | 1, i + frame, COUNT, {0}});
        }
        gpu_test_ok(gpu_frame_end(g));
        for (uint32_t i = 0; i < COUNT; i++) expected[i] = 7;
        for (uint32_t i = 0; i < steps * COUNT; i++) {
            uint32_t at = i / COUNT;
            expected[i % COUNT] = expected[i % COUNT] * (at | 1) + at + frame;
        }
        gpu_test_ok(gpu_buffer_read(g, buffer, 0, found, sizeof found));
        assert_memory_equal(found, expected, sizeof found);
    }
    gpu_buffer_destroy(g, buffer);
    gpu_pipeline_destroy(g, pipeline);
}

// One uniform block takes 1 KiB of its ring: 600 of them overflow two chunks of 256 KiB.
static void uniforms_survive_more_dispatches_than_a_chunk_holds(void **state) {
    count_in_frames(*state, 600, 2);
}

// Where descriptors are not pushed, each dispatch has a set: 300 in a frame are of several pools,
// which the frames that follow use again.
static void sets_do_what_pushed_descriptors_do(void **state) {
    (void)state;
    enum { STEPS = 300, TURNS = 3 };
    setenv("ROIL_PUSH_DESCRIPTORS", "0", 1);
    gpu *g = gpu_test_open(NULL);
    unsetenv("ROIL_PUSH_DESCRIPTORS");
    assert_true(g->push_descriptors == NULL);
    count_in_frames(g, STEPS, GPU_FRAMES_IN_FLIGHT);
    size_t pools = g->frames[0].batch.sets.count;
    assert_true(pools > 1);
    count_in_frames(g, STEPS, TURNS * GPU_FRAMES_IN_FLIGHT);
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++)
        assert_int_equal(g->frames[i].batch.sets.count, pools);
    gpu_test_close(g);
}

static void two_runs_are_equal_to_the_bit(void **state) {
    gpu *g = *state;
    enum { W = 64, H = 64 };
    static float runs[2][W * H];
    gpu_pipeline *pipeline = make_ramp(g);
    for (int run = 0; run < 2; run++) {
        gpu_image *image = make_image(g, GPU_R32F, W, H, 0, 1);
        gpu_test_ok(gpu_frame_begin(g));
        ramp(g, pipeline, image, 0.1f, 0.3f);
        gpu_test_ok(gpu_frame_end(g));
        gpu_test_ok(gpu_image_read(g, image, runs[run], sizeof runs[run]));
        gpu_image_destroy(g, image);
    }
    assert_memory_equal(runs[0], runs[1], sizeof runs[0]);
    gpu_pipeline_destroy(g, pipeline);
}

static void expect_error(bool result, const char *part) {
    assert_false(result);
    if (!strstr(err_get(), part)) fail_msg("'%s' does not say '%s'", err_get(), part);
}

static void wrong_bindings_are_named(void **state) {
    gpu *g = *state;
    gpu_pipeline *pipeline = make_ramp(g), *halving = make_halve(g);
    gpu_image *image = make_image(g, GPU_R32F, 8, 8, 0, 2);
    gpu_image *sampled = gpu_image_create(
        g,
        &(gpu_image_desc){.label = "plain", .format = GPU_R32F, .width = 8, .height = 8, .use = 1});
    gpu_test_ok(sampled);
    ramp_params params = {0};
    gpu_binding b[2] = {{.binding = 0, .uniform = &params, .uniform_size = sizeof params},
                        {.binding = 1, .image = image}};
    gpu_dispatch_desc d = {.pipeline = pipeline, .bindings = b, .binding_count = 2};
    expect_error(gpu_dispatch(g, &d), "no frame is open");
    gpu_test_ok(gpu_frame_begin(g));
    d.binding_count = 1;
    expect_error(gpu_dispatch(g, &d), "'ramp', binding 1: a storage image is needed, nothing");
    d.binding_count = 2;
    b[0].uniform = NULL;
    expect_error(gpu_dispatch(g, &d), "'ramp', binding 0: a uniform block is needed");
    b[0].uniform = &params;
    b[1].mip = 2;
    expect_error(gpu_dispatch(g, &d), "no level 2");
    b[1] = (gpu_binding){.binding = 1, .image = sampled};
    expect_error(gpu_dispatch(g, &d), "'plain' was not created for use as a storage image");
    gpu_binding same[2] = {{.binding = 0, .image = image}, {.binding = 1, .image = image}};
    d = (gpu_dispatch_desc){.pipeline = halving, .bindings = same, .binding_count = 2};
    expect_error(gpu_dispatch(g, &d), "in two ways at once");
    gpu_test_ok(gpu_frame_end(g));
    gpu_image_destroy(g, image);
    gpu_image_destroy(g, sampled);
    gpu_pipeline_destroy(g, pipeline);
    gpu_pipeline_destroy(g, halving);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(dispatch_writes_every_texel),
        cmocka_unit_test(volume_is_sampled_and_stored),
        cmocka_unit_test(each_level_follows_from_the_one_above),
        cmocka_unit_test(uniforms_survive_more_dispatches_than_a_chunk_holds),
        cmocka_unit_test(sets_do_what_pushed_descriptors_do),
        cmocka_unit_test(two_runs_are_equal_to_the_bit),
        cmocka_unit_test(wrong_bindings_are_named),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
