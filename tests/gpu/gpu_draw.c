// Drawing: coverage, depth test, culling, blending, scissors, viewports, indices, commands of the
// device, clearing, loading, and errors.
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <string.h>

enum { N = 16 };

typedef struct stage {
    gpu *g;
    gpu_pipeline *pipeline;
    gpu_image *color, *depth;
    gpu_buffer *points;
} stage;

static const float white[4] = {1, 1, 1, 1}, red[4] = {1, 0, 0, 1}, green[4] = {0, 1, 0, 1};

// Three triangles: the whole picture at depth 0.5, clockwise in the picture; its left half at 0.25
// and its upper half at 0.75, counter-clockwise.
static const float corners[9][4] = {
    {-1, -1, 0.5f, 1},  {3, -1, 0.5f, 1},  {-1, 3, 0.5f, 1}, //
    {-1, -3, 0.25f, 1}, {-1, 3, 0.25f, 1}, {0, 0, 0.25f, 1}, //
    {-3, 0, 0.75f, 1},  {3, 0, 0.75f, 1},  {0, -9, 0.75f, 1},
};

static gpu_pipeline *try_pipeline(gpu *g, gpu_format format, gpu_cull cull, bool blend) {
    const gpu_slot slots[] = {{.binding = 0, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true},
                              {.binding = 1, .kind = GPU_SLOT_UNIFORM}};
    return gpu_pipeline_create_graphics(
        g, &(gpu_graphics_desc){.label = "triangle",
                                .vertex_code = triangle_vert_code,
                                .vertex_size = sizeof triangle_vert_code,
                                .fragment_code = triangle_frag_code,
                                .fragment_size = sizeof triangle_frag_code,
                                .slots = slots,
                                .slot_count = COUNT_OF(slots),
                                .colors = {format},
                                .depth = GPU_D32F,
                                .cull = cull,
                                .blend = blend});
}

static stage stage_open(gpu *g, gpu_cull cull) {
    stage s = {.g = g, .pipeline = try_pipeline(g, GPU_RGBA32F, cull, false)};
    gpu_test_ok(s.pipeline);
    s.color = gpu_image_create(g, &(gpu_image_desc){.label = "color",
                                                    .format = GPU_RGBA32F,
                                                    .width = N,
                                                    .height = N,
                                                    .use = GPU_USE_TARGET | GPU_USE_SAMPLED});
    s.depth = gpu_image_create(g, &(gpu_image_desc){.label = "depth",
                                                    .format = GPU_D32F,
                                                    .width = N,
                                                    .height = N,
                                                    .use = GPU_USE_TARGET | GPU_USE_SAMPLED});
    s.points =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "points", .size = 3 * 4 * sizeof(float)});
    gpu_test_ok(s.color && s.depth && s.points);
    return s;
}

static void stage_close(stage *s) {
    gpu_pipeline_destroy(s->g, s->pipeline);
    gpu_image_destroy(s->g, s->color);
    gpu_image_destroy(s->g, s->depth);
    gpu_buffer_destroy(s->g, s->points);
}

static void draw(stage *s, int triangle, const float tint[4], bool clear) {
    gpu_test_ok(gpu_buffer_write(s->g, s->points, 0, corners[3 * triangle], 3 * sizeof *corners));
    const gpu_binding bindings[] = {{.binding = 0, .buffer = s->points},
                                    {.binding = 1, .uniform = tint, .uniform_size = 16}};
    gpu_draw one = {.bindings = bindings, .binding_count = COUNT_OF(bindings), .vertices = 3};
    gpu_test_ok(gpu_draw_all(s->g, &(gpu_draw_desc){.pipeline = s->pipeline,
                                                    .colors = {s->color},
                                                    .depth = s->depth,
                                                    .clear = clear,
                                                    .clear_color = {{0, 0, 1, 0}},
                                                    .clear_depth = 1.0f,
                                                    .draws = &one,
                                                    .draw_count = 1}));
}

static void expect_texel(float texels[N][N][4], int x, int y, const float wanted[4]) {
    if (memcmp(texels[y][x], wanted, 16) == 0) return;
    fail_msg("texel %d,%d is %g %g %g %g", x, y, (double)texels[y][x][0], (double)texels[y][x][1],
             (double)texels[y][x][2], (double)texels[y][x][3]);
}

static void nearer_triangle_wins_in_any_order(void **state) {
    static float texels[N][N][4], depths[N][N];
    static const float blue[4] = {0, 0, 1, 0};
    stage s = stage_open(*state, GPU_CULL_NONE);
    for (int order = 0; order < 2; order++) {
        gpu_test_ok(gpu_frame_begin(s.g));
        draw(&s, order ? 1 : 0, order ? red : white, true);
        draw(&s, order ? 0 : 1, order ? white : red, false);
        draw(&s, 2, green, false); // behind the white one everywhere
        gpu_test_ok(gpu_frame_end(s.g));
        gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
        gpu_test_ok(gpu_image_read(s.g, s.depth, depths, sizeof depths));
        expect_texel(texels, 1, N / 2, red);
        expect_texel(texels, N - 2, N / 2, white);
        expect_texel(texels, N - 2, 1, white);
        assert_true(depths[N / 2][1] == 0.25f && depths[1][N - 2] == 0.5f);
    }
    gpu_test_ok(gpu_frame_begin(s.g));
    draw(&s, 2, green, true);
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, N / 2, 2, green); // y = -1 of clip space is the top of the picture
    expect_texel(texels, N / 2, N - 2, blue);
    stage_close(&s);
}

static void clockwise_triangles_are_culled(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    stage s = stage_open(*state, GPU_CULL_BACK);
    gpu_test_ok(gpu_frame_begin(s.g));
    draw(&s, 0, white, true);
    draw(&s, 1, red, false);
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 1, N / 2, red);
    expect_texel(texels, N - 2, N / 2, blue);
    stage_close(&s);
}

// What is drawn `over` a colour becomes c + (1 - a) * old in all four channels.
static void premultiplied_colors_are_laid_over(void **state) {
    static uint8_t texels[N][N][4];
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_pipeline *plain = s.pipeline;
    gpu_image *old_color = s.color;
    s.pipeline = try_pipeline(s.g, GPU_RGBA8, GPU_CULL_NONE, true);
    s.color = gpu_image_create(
        s.g,
        &(gpu_image_desc){
            .label = "bytes", .format = GPU_RGBA8, .width = N, .height = N, .use = GPU_USE_TARGET});
    gpu_test_ok(s.pipeline && s.color);
    gpu_test_ok(gpu_frame_begin(s.g));
    draw(&s, 0, (const float[4]){0.2f, 0.4f, 0, 0.6f}, true); // over 0 0 1 0
    draw(&s, 1, (const float[4]){0.4f, 0, 0, 0}, false);      // the left half: only adds
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    static const int over[4] = {51, 102, 102, 153}, added[4] = {153, 102, 102, 153};
    for (int c = 0; c < 4; c++) {
        assert_true(abs(texels[N / 2][N - 2][c] - over[c]) <= 1);
        assert_true(abs(texels[N / 2][1][c] - added[c]) <= 1);
    }
    gpu_pipeline_destroy(s.g, plain);
    gpu_image_destroy(s.g, old_color);
    stage_close(&s);
}

static void integers_cannot_be_blended(void **state) {
    assert_null(try_pipeline(*state, GPU_R32U, GPU_CULL_NONE, true));
    assert_non_null(strstr(err_get(), "cannot blend colour target 0 of format r32u"));
}

// One buffer holds all corners; each draw takes its own triangle and its own part of the target.
static void draws_begin_at_their_vertex_inside_their_scissor(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *all =
        gpu_buffer_create(s.g, &(gpu_buffer_desc){.label = "all", .size = sizeof corners});
    gpu_test_ok(all);
    gpu_test_ok(gpu_buffer_write(s.g, all, 0, corners, sizeof corners));
    const float *tints[5] = {white, red, green, red, red};
    gpu_draw draws[5] = {
        {.scissor = {4, 8, 5, 6}},
        {.first_vertex = 3}, // the left half, and nearer: the scissor before it is forgotten
        {.first_vertex = 6, .scissor = {10, 2, UINT32_MAX, 3}}, // reaches beyond the target
        {.scissor = {N, 0, 4, N}},                              // outside
        {.scissor = {0, 0, N, 0}},                              // empty
    };
    gpu_binding bindings[5][2];
    for (int i = 0; i < 5; i++) {
        bindings[i][0] = (gpu_binding){.binding = 0, .buffer = all};
        bindings[i][1] = (gpu_binding){.binding = 1, .uniform = tints[i], .uniform_size = 16};
        draws[i].bindings = bindings[i];
        draws[i].binding_count = 2;
        draws[i].vertices = 3;
    }
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_draw_all(s.g, &(gpu_draw_desc){.pipeline = s.pipeline,
                                                   .colors = {s.color},
                                                   .depth = s.depth,
                                                   .clear = true,
                                                   .clear_color = {{0, 0, 1, 0}},
                                                   .clear_depth = 1.0f,
                                                   .draws = draws,
                                                   .draw_count = COUNT_OF(draws)}));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 8, 8, white); // corners of the first scissor, right of the red half
    expect_texel(texels, 8, 13, white);
    expect_texel(texels, 8, 7, blue);
    expect_texel(texels, 8, 14, blue);
    expect_texel(texels, 9, 10, blue);
    expect_texel(texels, 1, N / 2, red);
    expect_texel(texels, 10, 2, green);
    expect_texel(texels, N - 1, 4, green);
    expect_texel(texels, N - 1, 5, blue);
    expect_texel(texels, N - 1, 1, blue);
    expect_texel(texels, 9, 3, blue);
    gpu_buffer_destroy(s.g, all);
    stage_close(&s);
}

static gpu_buffer *make_buffer(gpu *g, const char *label, const void *data, size_t size) {
    gpu_buffer *buffer = gpu_buffer_create(g, &(gpu_buffer_desc){.label = label, .size = size});
    gpu_test_ok(buffer && gpu_buffer_write(g, buffer, 0, data, size));
    return buffer;
}

static gpu_draw_desc draw_over(const stage *s, const gpu_draw *draws, size_t count) {
    return (gpu_draw_desc){.pipeline = s->pipeline,
                           .colors = {s->color},
                           .depth = s->depth,
                           .clear = true,
                           .clear_color = {{0, 0, 1, 0}},
                           .clear_depth = 1.0f,
                           .draws = draws,
                           .draw_count = count};
}

// By indices the left half and the upper half are drawn out of one buffer, in one call.
static void indices_name_the_vertices(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    static const uint32_t order[] = {8, 8, 3, 4, 5, 6, 7, 8};
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *all = make_buffer(s.g, "all", corners, sizeof corners);
    gpu_buffer *indices = make_buffer(s.g, "indices", order, sizeof order);
    const gpu_binding bindings[] = {{.binding = 0, .buffer = all},
                                    {.binding = 1, .uniform = red, .uniform_size = 16}};
    gpu_draw one = {.bindings = bindings,
                    .binding_count = 2,
                    .indices = indices,
                    .first_vertex = 2,
                    .vertices = 6};
    gpu_draw_desc desc = draw_over(&s, &one, 1);
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    one.vertices = 7;
    assert_false(gpu_draw_all(s.g, &desc));
    assert_non_null(strstr(err_get(), "indices up to 9 are drawn; buffer 'indices' holds 8"));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 1, N - 2, red);
    expect_texel(texels, N - 2, 1, red);
    expect_texel(texels, N - 2, N - 2, blue);
    gpu_buffer_destroy(s.g, indices);
    gpu_buffer_destroy(s.g, all);
    stage_close(&s);
}

// What is drawn changes on the device, in the frame itself: to the left half by vertices, then to
// the upper half by indices.
static void commands_are_read_by_the_device(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    static const uint32_t order[] = {6, 7, 8};
    static const gpu_draw_command plain = {.vertices = 3, .instances = 1, .first_vertex = 3};
    static const gpu_draw_indexed_command indexed = {.indices = 3, .instances = 1};
    uint32_t words[9] = {0};
    memcpy(words + 1, &plain, sizeof plain); // not at the beginning
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *all = make_buffer(s.g, "all", corners, sizeof corners);
    gpu_buffer *indices = make_buffer(s.g, "indices", order, sizeof order);
    gpu_buffer *first = make_buffer(s.g, "first", words, sizeof words);
    memcpy(words + 1, &indexed, sizeof indexed);
    gpu_buffer *second = make_buffer(s.g, "second", words, sizeof words);
    gpu_buffer *commands = make_buffer(s.g, "commands", words, sizeof words);
    const gpu_binding bindings[] = {{.binding = 0, .buffer = all},
                                    {.binding = 1, .uniform = red, .uniform_size = 16}};
    gpu_draw one = {.bindings = bindings, .binding_count = 2, .commands = commands, .command = 4};
    gpu_draw_desc desc = draw_over(&s, &one, 1);
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_buffer_copy(s.g, first, commands, sizeof words));
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    gpu_test_ok(gpu_buffer_copy(s.g, second, commands, sizeof words));
    one.indices = indices;
    desc.clear = false;
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 1, N - 2, red);
    expect_texel(texels, N - 2, 1, red);
    expect_texel(texels, N - 2, N - 2, blue);
    gpu_buffer *const buffers[] = {all, indices, first, second, commands};
    for (size_t i = 0; i < COUNT_OF(buffers); i++) gpu_buffer_destroy(s.g, buffers[i]);
    stage_close(&s);
}

// Both halves, at once.
static void commands_follow_one_another(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    static const gpu_draw_command both[] = {{.vertices = 3, .instances = 1, .first_vertex = 3},
                                            {.vertices = 3, .instances = 1, .first_vertex = 6}};
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *all = make_buffer(s.g, "all", corners, sizeof corners);
    gpu_buffer *commands = make_buffer(s.g, "commands", both, sizeof both);
    const gpu_binding bindings[] = {{.binding = 0, .buffer = all},
                                    {.binding = 1, .uniform = red, .uniform_size = 16}};
    gpu_draw two = {
        .bindings = bindings, .binding_count = 2, .commands = commands, .commands_drawn = 2};
    gpu_draw_desc desc = draw_over(&s, &two, 1);
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 1, N - 2, red);
    expect_texel(texels, N - 2, 1, red);
    expect_texel(texels, N - 2, N - 2, blue);
    gpu_buffer_destroy(s.g, commands);
    gpu_buffer_destroy(s.g, all);
    stage_close(&s);
}

static void commands_beyond_their_buffer_are_refused(void **state) {
    static const uint32_t words[8] = {0};
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *commands = make_buffer(s.g, "commands", words, sizeof words);
    const gpu_binding bindings[] = {{.binding = 0, .buffer = s.points},
                                    {.binding = 1, .uniform = red, .uniform_size = 16}};
    gpu_draw one = {.bindings = bindings, .binding_count = 2, .commands = commands};
    gpu_draw_desc desc = draw_over(&s, &one, 1);
    gpu_test_ok(gpu_frame_begin(s.g));
    static const uint64_t wrong[] = {2, 20, 32, UINT64_MAX - 3};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        one.command = wrong[i];
        assert_false(gpu_draw_all(s.g, &desc));
        assert_non_null(strstr(err_get(), "of buffer 'commands' is not whole words inside it"));
    }
    one.command = 16;
    gpu_test_ok(gpu_draw_all(s.g, &desc)); // draws nothing
    one.commands_drawn = 2;
    assert_false(gpu_draw_all(s.g, &desc));
    one.command = 0;
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_buffer_destroy(s.g, commands);
    stage_close(&s);
}

// A viewport holds the whole view, and nothing is drawn beside it; a scissor is of the target.
static void views_lie_in_their_viewports(void **state) {
    static float texels[N][N][4];
    static const float blue[4] = {0, 0, 1, 0};
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_buffer *all = make_buffer(s.g, "all", corners, sizeof corners);
    const float *tints[3] = {white, red, green};
    gpu_draw draws[3] = {
        {.viewport = {0, 0, 8, 4}},
        {.viewport = {8, 4, 8, 8}, .first_vertex = 3}, // its left half
        {.viewport = {0, 8, 8, 8}, .scissor = {2, 10, 2, 2}},
    };
    gpu_binding bindings[3][2];
    for (int i = 0; i < 3; i++) {
        bindings[i][0] = (gpu_binding){.binding = 0, .buffer = all};
        bindings[i][1] = (gpu_binding){.binding = 1, .uniform = tints[i], .uniform_size = 16};
        draws[i].bindings = bindings[i];
        draws[i].binding_count = 2;
        draws[i].vertices = 3;
    }
    gpu_draw_desc desc = draw_over(&s, draws, COUNT_OF(draws));
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_draw_all(s.g, &desc));
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    for (int y = 0; y < N; y++) {
        for (int x = 0; x < N; x++) {
            if (x == 11 || x == 10) continue; // the edge of the red triangle is slanted
            bool is_red = x >= 8 && x < 10 && y == 8;
            if (x < 8 && y < 4)
                expect_texel(texels, x, y, white);
            else if (x >= 2 && x < 4 && y >= 10 && y < 12)
                expect_texel(texels, x, y, green);
            else if (is_red)
                expect_texel(texels, x, y, red);
            else if (x < 8 || y < 4 || y >= 12 || x >= 12)
                expect_texel(texels, x, y, blue);
        }
    }
    gpu_buffer_destroy(s.g, all);
    stage_close(&s);
}

static void no_draws_just_clears(void **state) {
    static float texels[N][N][4];
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_test_ok(gpu_frame_begin(s.g));
    gpu_test_ok(gpu_draw_all(s.g, &(gpu_draw_desc){.colors = {s.color},
                                                   .clear = true,
                                                   .clear_color = {{0.25f, 0.5f, 0.75f, 1.0f}}}));
    gpu_image_clear(s.g, s.depth, (const float[4]){0.125f, 0, 0, 0});
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_test_ok(gpu_image_read(s.g, s.color, texels, sizeof texels));
    expect_texel(texels, 3, 5, (const float[4]){0.25f, 0.5f, 0.75f, 1.0f});
    static float depths[N][N];
    gpu_test_ok(gpu_image_read(s.g, s.depth, depths, sizeof depths));
    assert_true(depths[N - 1][N - 1] == 0.125f);
    stage_close(&s);
}

static void expect_error(bool result, const char *part) {
    assert_false(result);
    if (!strstr(err_get(), part)) fail_msg("'%s' does not say '%s'", err_get(), part);
}

static void wrong_targets_are_named(void **state) {
    stage s = stage_open(*state, GPU_CULL_NONE);
    gpu_image *small = gpu_image_create(s.g, &(gpu_image_desc){.label = "small",
                                                               .format = GPU_RGBA16F,
                                                               .width = N / 2,
                                                               .height = N,
                                                               .use = GPU_USE_TARGET});
    gpu_image *plain = gpu_image_create(
        s.g,
        &(gpu_image_desc){.label = "plain", .format = GPU_R8, .width = N, .height = N, .use = 1});
    gpu_test_ok(small && plain);
    gpu_draw one = {.vertices = 3};
    gpu_draw_desc d = {.pipeline = s.pipeline, .draws = &one, .draw_count = 1};
    gpu_test_ok(gpu_frame_begin(s.g));
    expect_error(gpu_draw_all(s.g, &d), "needs a target");
    d.colors[0] = small;
    d.depth = s.depth;
    expect_error(gpu_draw_all(s.g, &d), "differ in size");
    d.depth = NULL;
    expect_error(gpu_draw_all(s.g, &d), "1 colour targets and depth; 1 are given");
    d.colors[0] = plain;
    expect_error(gpu_draw_all(s.g, &d), "'plain' was not created for use as a target");
    d.colors[0] = s.color;
    d.depth = s.depth;
    expect_error(gpu_draw_all(s.g, &d), "'triangle', binding 0: a storage buffer is needed");
    gpu_test_ok(gpu_frame_end(s.g));
    gpu_image_destroy(s.g, small);
    gpu_image_destroy(s.g, plain);
    stage_close(&s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearer_triangle_wins_in_any_order),
        cmocka_unit_test(clockwise_triangles_are_culled),
        cmocka_unit_test(premultiplied_colors_are_laid_over),
        cmocka_unit_test(integers_cannot_be_blended),
        cmocka_unit_test(draws_begin_at_their_vertex_inside_their_scissor),
        cmocka_unit_test(indices_name_the_vertices),
        cmocka_unit_test(commands_are_read_by_the_device),
        cmocka_unit_test(commands_follow_one_another),
        cmocka_unit_test(commands_beyond_their_buffer_are_refused),
        cmocka_unit_test(views_lie_in_their_viewports),
        cmocka_unit_test(no_draws_just_clears),
        cmocka_unit_test(wrong_targets_are_named),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
