// One effect takes over from another: histories, decoded grids and meshes go on, a failure leaves
// all as it was.
#include "effect_test.h"
#include "field/sequence.h"
#include "scene/sky_image.h"

enum { SIZE = 17 };

static effect *open_trail(gpu *device) {
    effect *e = open_effect(&(effect_desc){.device = device});
    pass *trail = add(e, NULL, "trail.comp");
    gpu_test_ok(pass_declare(trail));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(trail, "count")));
    return e;
}

static effect *open_compiled_trail(gpu *device) {
    effect *e = open_trail(device);
    gpu_test_ok(effect_compile(e));
    return e;
}

static void history_goes_on_in_the_next_effect(void **state) {
    effect *old = open_compiled_trail(*state);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE));
    for (int i = 1; i <= 3; i++) assert_true(middle(old, i, SIZE, 0) == (float)i);
    effect *next = open_compiled_trail(*state);
    gpu_test_ok(effect_adopt(next, old, SIZE, SIZE));
    effect_destroy(old);
    assert_true(middle(next, 4, SIZE, 0) == 4); // the frame after the last one of `old`
    assert_true(middle(next, 5, SIZE, 0) == 5);
    assert_true(middle(next, 9, SIZE, 0) == 1); // a jump, as ever
    effect_destroy(next);
}

static void other_size_begins_anew(void **state) {
    effect *old = open_compiled_trail(*state), *next = open_compiled_trail(*state);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE));
    assert_true(middle(old, 1, SIZE, 0) == 1 && middle(old, 2, SIZE, 0) == 2);
    gpu_test_ok(effect_adopt(next, old, 40, 40));
    effect_destroy(old);
    assert_true(middle(next, 3, 40, 0) == 1);
    effect_destroy(next);
}

static void failure_leaves_the_old_effect_as_it_was(void **state) {
    effect *old = open_compiled_trail(*state), *next = open_trail(*state);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE));
    assert_true(middle(old, 1, SIZE, 0) == 1 && middle(old, 2, SIZE, 0) == 2);
    // No device has so much memory for one image.
    pass *more = add(next, NULL, "trail.comp");
    gpu_test_ok(pass_declare(more));
    graph_image huge = graph_add_image(effect_graph(next), &(graph_image_desc){
                                                               .name = "huge",
                                                               .format = GPU_RGBA32F,
                                                               .width = 16384,
                                                               .height = 16384,
                                                               .depth = 2048,
                                                           });
    assert_true(huge.id);
    gpu_test_ok(graph_add_pass(
        effect_graph(next),
        &(graph_pass_desc){.name = "huge", .writes = &huge, .write_count = 1, .keep = true}));
    gpu_test_ok(effect_compile(next));
    assert_false(effect_adopt(next, old, SIZE, SIZE));
    assert_non_null(strstr(err_get(), "huge"));
    effect_destroy(next);
    assert_true(middle(old, 3, SIZE, 0) == 3);
    effect_destroy(old);
}

// ---- sequences --------------------------------------------------------------------------------

static content_cache *kept;

static effect *open_player(gpu *device, float offset, field_grid **grid) {
    char pattern[4096];
    snprintf(pattern, sizeof pattern, "%s/effects/data/explosion-32/000*.vdb",
             getenv("ROIL_SOURCE_DIR"));
    effect *e = open_effect(&(effect_desc){.device = device, .contents = kept});
    sequence *s = sequence_create(
        effect_memory(e),
        &(sequence_desc){.pattern = pattern, .offset = {offset, 0, 0}, .contents = kept});
    gpu_test_ok(s);
    *grid = sequence_grid(s);
    effect_add_grid(e, *grid);
    int components, first = sequence_channel(s, "density", &components);
    gpu_test_ok(first >= 0);
    pass *p = add_march(e, field_grid_channel(effect_memory(e), *grid, first, components));
    gpu_test_ok(pass_declare(p));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "color")));
    gpu_test_ok(effect_compile(e));
    return e;
}

// The texture shown before and after another effect took over, and again.
static void play(gpu *device, float offset, bool same) {
    field_grid *old_grid, *next_grid;
    kept = content_cache_create();
    effect *old = open_player(device, 0, &old_grid);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE) && effect_render(old, 1, true));
    float *before = read_picture(old);
    const gpu_image *shown = old_grid->state.images[0][0];
    assert_non_null(shown);
    effect *next = open_player(device, offset, &next_grid);
    gpu_test_ok(effect_rehearse(next, 1) && effect_adopt(next, old, SIZE, SIZE));
    gpu_test_ok(effect_render(next, 1, true));
    float *after = read_picture(next);
    assert_int_equal(next_grid->state.images[0][0] == shown, same);
    effect_destroy(old);
    if (same) assert_memory_equal(before, after, SIZE * SIZE * 4 * sizeof *after);
    for (int frame = 2; frame < 12; frame++) gpu_test_ok(effect_render(next, frame, true));
    mem_free(before);
    mem_free(after);
    effect_destroy(next);
    content_cache_destroy(kept);
}

static void decoded_frames_are_handed_on(void **state) {
    play(*state, 0, true);
}

static void frames_that_lie_elsewhere_are_not(void **state) {
    play(*state, 1, false);
}

// ---- meshes -----------------------------------------------------------------------------------

static effect *open_mesh(gpu *device, scene_mesh **mesh) {
    effect *e = open_effect(&(effect_desc){.device = device, .contents = kept});
    *mesh = effect_add_mesh(e, "crate.obj");
    gpu_test_ok(*mesh);
    pass *p = add(e, "geometry", NULL);
    gpu_test_ok(pass_set_option(p, "mode", "raster")); // rays need no vertices
    gpu_test_ok(pass_add_mesh(p, *mesh) && pass_declare(p));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "albedo")));
    gpu_test_ok(effect_compile(e));
    return e;
}

static void mesh_is_imported_and_uploaded_once(void **state) {
    scene_mesh *first, *second;
    kept = content_cache_create();
    effect *old = open_mesh(*state, &first);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE) && effect_render(old, 1, true));
    gpu_buffer *vertices = first->vertices;
    assert_non_null(vertices);
    effect *next = open_mesh(*state, &second);
    assert_ptr_equal(first->data.vertices, second->data.vertices);
    gpu_test_ok(effect_adopt(next, old, SIZE, SIZE));
    assert_ptr_equal(second->vertices, vertices);
    assert_null(first->vertices);
    effect_destroy(old);
    gpu_test_ok(effect_render(next, 2, true));
    effect_destroy(next);
    content_cache_destroy(kept);
}

// ---- sky --------------------------------------------------------------------------------------

static effect *open_sky(gpu *device) {
    effect *e = open_effect(&(effect_desc){.device = device, .contents = kept});
    scene *s = effect_scene(e);
    s->sky.image = effect_add_sky_image(e, "sky.exr");
    s->sky.strength = number(e, 1);
    gpu_test_ok(s->sky.image);
    pass *p = add(e, NULL, "sky_probe.comp");
    gpu_test_ok(pass_declare(p) && effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "color")));
    gpu_test_ok(effect_compile(e));
    return e;
}

static void sky_is_read_and_uploaded_once(void **state) {
    kept = content_cache_create();
    effect *old = open_sky(*state);
    gpu_test_ok(effect_allocate(old, SIZE, SIZE));
    float before = middle(old, 1, SIZE, 0);
    gpu_image *texture = sky_image_texture(effect_scene(old)->sky.image);
    effect *next = open_sky(*state);
    gpu_test_ok(effect_adopt(next, old, SIZE, SIZE));
    assert_ptr_equal(sky_image_texture(effect_scene(next)->sky.image), texture);
    assert_null(sky_image_texture(effect_scene(old)->sky.image));
    effect_destroy(old);
    assert_true(before > 0 && middle(next, 2, SIZE, 0) == before);
    effect_destroy(next);
    content_cache_destroy(kept);
}

// ---- rehearsal --------------------------------------------------------------------------------

static bool call_hook(void *user, int function, double time, float out[4]) {
    (void)user;
    out[0] = 1;
    return time < 1 || err_set("effect.lua:%d: too late", function);
}

static void rehearsal_finds_what_a_frame_would(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    effect_set_hooks(e, &(effect_hooks){.call = call_hook});
    pass *p = add_march(e, block(e, field_call(effect_memory(e), 1, 7)));
    gpu_test_ok(pass_declare(p));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "color")));
    gpu_test_ok(effect_compile(e));
    gpu_test_ok(effect_rehearse(e, 1));
    assert_false(effect_rehearse(e, 1000));
    assert_string_equal(err_get(), "pass 'march': effect.lua:7: too late");
    gpu_test_ok(effect_allocate(e, SIZE, SIZE) && effect_render(e, 1, false));
    effect_destroy(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(history_goes_on_in_the_next_effect),
        cmocka_unit_test(other_size_begins_anew),
        cmocka_unit_test(failure_leaves_the_old_effect_as_it_was),
        cmocka_unit_test(decoded_frames_are_handed_on),
        cmocka_unit_test(frames_that_lie_elsewhere_are_not),
        cmocka_unit_test(mesh_is_imported_and_uploaded_once),
        cmocka_unit_test(sky_is_read_and_uploaded_once),
        cmocka_unit_test(rehearsal_finds_what_a_frame_would),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
