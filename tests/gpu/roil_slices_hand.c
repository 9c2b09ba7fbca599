// Flows in a user's hands through the public interface: what is seen, pushed, captured and put.
#include "media/picture.h"
#include "roil_test.h"

enum { SIDE = 32 };

static const char CALM[] = "local fx = effect { name = 'calm', fps = 60, frames = 1000 }\n"
                           "local air = slices { count = 2, size = {32, 64}, height = 2, "
                           "variation = 0 }\n"
                           "%s\n"
                           "fx.output = final { march { density = air.density } }.color\n"
                           "return fx\n";
static const char RISING[] =
    "air:force { force = {0, 4}, shape = disc { 0.5, 0.5, radius = 0.2 } }";

static roil_effect *open(roil *r, const char *more) {
    char text[1024];
    snprintf(text, sizeof text, CALM, more);
    roil_effect *e = load_text(r, "calm.lua", text);
    ok(roil_prepare(e, 8, 8));
    return e;
}

static float speed(roil_effect *e, uint32_t slice) {
    float most;
    ok(roil_slices_greatest(e, &(roil_slices_view){.slice = slice, .field = ROIL_SLICES_VELOCITY},
                            &most));
    return most;
}

static void flows_are_listed(void **state) {
    roil_slices list[2];
    roil_effect *e = open(*state, "local other = slices { size = {16, 16}, height = 1 }");
    assert_int_equal(roil_slices_list(e, list, 1), 2);
    assert_int_equal(roil_slices_list(e, list, 2), 2);
    assert_string_equal(list[0].name, "air");
    assert_string_equal(list[1].name, "other");
    assert_int_equal(list[0].count, 2);
    assert_int_equal(list[0].size[1], 64);
    assert_true(list[0].width == 1 && list[0].height == 2);
    roil_unload(e);
}

static void a_push_moves_its_slice_alone(void **state) {
    roil_effect *e = open(*state, "");
    const roil_slices_square where = {.slice = 1, .middle = {0.5f, 1}, .side = 0.4f};
    expect_error(roil_slices_draw(e, &(roil_slices_view){.range = 1}, NULL), "nothing has flowed");
    ok(roil_render(e, 0));
    ok(roil_slices_push(e, &where, (float[2]){30, 0}));
    ok(roil_render(e, 3));
    assert_true(speed(e, 0) < 1e-4f);
    assert_true(speed(e, 1) > 0.05f && speed(e, 1) < 0.5f); // 30 m/s^2 in a 60th of a second
    roil_unload(e);
}

static void what_is_pushed_to_the_right_is_seen_red(void **state) {
    roil_effect *e = open(*state, "");
    const roil_slices_square where = {.middle = {0.5f, 1}, .side = 0.6f};
    ok(roil_render(e, 0));
    ok(roil_slices_push(e, &where, (float[2]){60, 0}));
    ok(roil_render(e, 3));
    roil_slices_view view = {.field = ROIL_SLICES_VELOCITY, .range = speed(e, 0)};
    roil_texture *t = roil_texture_create(*state, SIDE, 2 * SIDE, NULL);
    uint8_t shown[SIDE * 2 * SIDE * 4];
    ok(roil_slices_draw(e, &view, t));
    const roil_vertex corners[4] = {{0, 0, 0, 0, UINT32_MAX},
                                    {SIDE, 0, 1, 0, UINT32_MAX},
                                    {SIDE, 2 * SIDE, 1, 1, UINT32_MAX},
                                    {0, 2 * SIDE, 0, 1, UINT32_MAX}};
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const roil_draw whole = {t, 0, 6, {0, 0, SIDE, 2 * SIDE}};
    ok(roil_show(*state, &(roil_picture){.width = SIDE,
                                         .height = 2 * SIDE,
                                         .vertices = corners,
                                         .indices = indices,
                                         .draws = &whole,
                                         .vertex_count = 4,
                                         .index_count = 6,
                                         .draw_count = 1}));
    ok(roil_read_shown(*state, shown));
    const uint8_t *middle = shown + 4 * (SIDE * SIDE + SIDE / 2);
    assert_true(middle[0] > 120 && middle[0] > middle[1] + 30 && middle[0] > middle[2] + 30);
    view.range = 0;
    expect_error(roil_slices_draw(e, &view, t), "range");
    roil_texture_destroy(*state, t);
    roil_unload(e);
}

static void capture_writes_a_template(void **state) {
    roil_effect *e = open(*state, RISING);
    const roil_slices_square where = {.middle = {0.5f, 0.5f}, .side = 0.5f};
    float scale[2];
    ok(roil_render(e, 12));
    ok(roil_slices_capture(e, &where, "grown-1", scale));
    assert_true(scale[0] > 0.01f && scale[0] < 2 && scale[1] > 0);
    expect_error(roil_slices_capture(e, &where, "grown-1", scale), "there already");
    expect_error(roil_slices_capture(e, &where, "../grown", scale), "is not a name");
    expect_error(roil_slices_capture(e, &where, "a/b", scale), "is not a name");
    expect_error(roil_slices_capture(e, &where, "", scale), "is not a name");
    expect_error(roil_slices_capture(e, &(roil_slices_square){.side = 0}, "other", scale),
                 "no square");
    expect_error(roil_slices_push(e, &(roil_slices_square){.slice = 2, .side = 1}, scale),
                 "no slice 3");
    arena memory = {0};
    picture image;
    char path[512];
    snprintf(path, sizeof path, "%s/templates/grown-1.exr", test_folder);
    ok(picture_read(path, test_folder, 128, &memory, &image));
    assert_int_equal(image.width, 64);
    const float *middle = image.rgba + 4 * (32 * 64 + 32), *corner = image.rgba;
    assert_true(middle[1] > 0.3f && middle[3] > 0.9f); // up, and all of it
    assert_true(corner[3] < 0.05f);
    arena_free(&memory);
    roil_unload(e);
}

static void templates_are_of_the_effect_and_of_the_library(void **state) {
    roil_template list[64];
    char path[512];
    roil_effect *e = open(*state, "");
    size_t count = roil_templates(e, list, 64), found = 0;
    for (size_t i = 0; i < count; i++) {
        found += strcmp(list[i].file, "jet.exr") == 0 && list[i].library;
        if (i > 0) assert_true(strcmp(list[i - 1].file, list[i].file) < 0);
    }
    assert_int_equal(found, 1);
    write_text("templates/jet.exr", "one of that name", path);
    assert_int_equal(roil_templates(e, list, 64), count);
    found = 0;
    for (size_t i = 0; i < count; i++)
        found += strcmp(list[i].file, "jet.exr") == 0 && !list[i].library;
    assert_int_equal(found, 1);
    assert_int_equal(remove(path), 0);
    uint8_t icon[8 * 8 * 4];
    ok(roil_template_icon(e, "source.exr", false, 8, icon));
    assert_true(icon[4 * (4 * 8 + 4) + 1] > 120 && icon[1] < 60); // green in the middle
    expect_error(roil_template_icon(e, "sheet.png", false, 8, icon), "not square");
    expect_error(roil_template_icon(e, "../step.png", false, 8, icon), "is not a name");
    expect_error(roil_template_icon(e, "nothing.exr", false, 8, icon), "there is no template");
    roil_unload(e);
}

static void a_template_that_is_put_acts_for_its_lifetime(void **state) {
    roil_effect *e = open(*state, "");
    const roil_template_use jet = {.where = {.slice = 1, .middle = {0.5f, 1}, .side = 0.5f},
                                   .file = "jet.exr",
                                   .velocity = true,
                                   .strength = 30,
                                   .lifetime = 0.1};
    ok(roil_render(e, 0));
    ok(roil_template_put(e, &jet));
    ok(roil_render(e, 2));
    float early = speed(e, 1);
    ok(roil_render(e, 6));
    float grown = speed(e, 1);
    ok(roil_render(e, 60));
    assert_true(early > 0.01f && grown > 1.5f * early);
    assert_true(speed(e, 1) < grown); // no more comes
    assert_true(speed(e, 0) < 1e-4f);
    roil_unload(e);
}

// The line that the tools give is one that the effect takes, with a file that it can read.
static void its_line_can_be_pasted(void **state) {
    roil_effect *e = open(*state, "");
    const roil_template_use use = {.where = {.middle = {0.5f, 1}, .side = 0.5f},
                                   .file = "pump.exr",
                                   .angle = 30,
                                   .strength = 2,
                                   .blend = 0.02f,
                                   .lifetime = 0.2};
    char *line = roil_template_lua(e, &use);
    ok(line != NULL);
    assert_non_null(
        strstr(line, "air:templates { image \"templates/pump.exr\", kind = \"pressure\""));
    roil_unload(e);
    e = open(*state, line);
    ok(roil_render(e, 20));
    assert_true(speed(e, 0) > 0.01f);
    roil_free(line);
    roil_unload(e);
}

// Whoever saved it had no hands.
static void a_checkpoint_is_taken_up(void **state) {
    char file[512];
    snprintf(file, sizeof file, "%s/state", test_folder);
    roil *other = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true});
    ok(other);
    roil_effect *e = open(other, RISING);
    ok(roil_render(e, 12));
    float left = speed(e, 0);
    ok(roil_checkpoint(e, file));
    roil_unload(e);
    assert_int_equal(roil_validation_messages(other), 0);
    roil_destroy(other);
    double frame;
    e = open(*state, RISING);
    ok(roil_restore(e, file, &frame));
    ok(roil_render(e, frame + 1));
    assert_true(left > 0.01f && speed(e, 0) > left);
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flows_are_listed),
        cmocka_unit_test(a_push_moves_its_slice_alone),
        cmocka_unit_test(what_is_pushed_to_the_right_is_seen_red),
        cmocka_unit_test(capture_writes_a_template),
        cmocka_unit_test(templates_are_of_the_effect_and_of_the_library),
        cmocka_unit_test(a_template_that_is_put_acts_for_its_lifetime),
        cmocka_unit_test(its_line_can_be_pasted),
        cmocka_unit_test(a_checkpoint_is_taken_up),
    };
    test_interaction = true;
    return test_run(tests);
}
