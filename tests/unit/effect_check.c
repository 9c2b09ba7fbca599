// What is found wrong with an effect before any device is there.
#include "effect_helper.h"

#include "base/isolate.h"

static void set_output(stage *s, pass *p) {
    ok(pass_declare(p));
    ok(effect_set_picture(s->e, EFFECT_OUTPUT, pass_output(p, "color")));
}

// ---- shaders and fields -------------------------------------------------------------------------

static field_grid *add_bake(effect *e, const field *node, const uint32_t size[3], box3 box) {
    return effect_add_bake(e, node,
                           &(effect_bake_desc){.size = {size[0], size[1], size[2]}, .box = box});
}

static void effect_of_all_built_in_passes_is_sound(void **state) {
    stage *s = *state;
    effect *e = s->e;
    field_grid *grid =
        add_bake(e, ball(s), (uint32_t[3]){8, 8, 8}, (box3){{-1, -1, -1}, {1, 1, 1}});
    ok(grid);
    pass *geometry = effect_add_pass(e, "geometry", NULL, NULL);
    ok(geometry && pass_declare(geometry));
    pass *shade = effect_add_pass(e, "shade", NULL, NULL);
    ok(shade);
    pass_add_source(shade, geometry);
    ok(pass_declare(shade));
    pass *march = effect_add_pass(e, "march", NULL, NULL);
    ok(march && pass_set_field(march, "density", field_grid_channel(effect_memory(e), grid, 0, 1)));
    ok(pass_set_image(march, "depth", pass_output(geometry, "depth")));
    ok(pass_declare(march));
    pass *over = effect_add_pass(e, "over", NULL, NULL);
    ok(over && pass_set_image(over, "volume", pass_output(march, "color")));
    ok(pass_set_image(over, "source", pass_output(shade, "color")));
    ok(pass_declare(over));
    pass *bright = effect_add_pass(e, "bright", NULL, NULL);
    ok(bright && pass_set_image(bright, "source", pass_output(over, "color")));
    ok(pass_declare(bright));
    pass *bloom = effect_add_pass(e, "bloom", NULL, NULL);
    ok(bloom && pass_set_image(bloom, "source", pass_output(bright, "color")));
    ok(pass_declare(bloom));
    pass *final = effect_add_pass(e, "final", NULL, NULL);
    ok(final && pass_set_image(final, "source", pass_output(over, "color")));
    ok(pass_set_image(final, "bloom", pass_output(bloom, "color")));
    set_output(s, final);
    ok(effect_set_picture(e, EFFECT_LINEAR, pass_output(final, "linear")));
    ok(effect_set_picture(e, EFFECT_DEPTH, pass_output(geometry, "depth")));
    ok(effect_check(e));
    assert_int_equal(effect_pass_count(e), 8);
}

static void volume_in_other_units_is_told_of(void **state) {
    stage *s = *state;
    set_output(s, add_march(s, "ball"));
    ok(effect_check(s->e));
    assert_null(effect_get_warning(s->e));
    open_with(s, NULL, 0);
    set_output(s, add_march(s, "ball"));
    effect_scene(s->e)->camera.distance = number(s, 1e4f);
    ok(effect_check(s->e));
    assert_non_null(effect_get_warning(s->e));
    assert_non_null(strstr(effect_get_warning(s->e), "'ball' is only 2 m long"));
}

static void mistake_in_a_users_shader_is_found_without_a_device(void **state) {
    stage *s = *state;
    write_file(s, "tinted.comp",
               "writeonly uniform image2D color; //= output rgba16f : a picture\n"
               "void main() {\n"
               "    imageStore(color, ivec2(0), vec4(tint, 1.0));\n"
               "}\n");
    pass *p = effect_add_pass(s->e, NULL, "tinted.comp", NULL);
    ok(p);
    set_output(s, p);
    assert_false(effect_check(s->e));
    assert_error("tinted: ");
    assert_error("tinted.comp:3: ");
    assert_error("tint");
}

static void mistake_in_an_annotation_is_found_when_the_pass_is_added(void **state) {
    stage *s = *state;
    write_file(s, "wrong.comp",
               "uniform float gain; //= 3 [0, 1] : above its own range\n"
               "writeonly uniform image2D color; //= output rgba16f : a picture\n"
               "void main() {}\n");
    assert_null(effect_add_pass(s->e, NULL, "wrong.comp", NULL));
    assert_error("wrong.comp:1: ");
}

static void users_function_that_is_not_there_is_found(void **state) {
    stage *s = *state;
    write_file(s, "own.glsl", "float here(vec3 p) { return 1.0; }\n");
    const field_glsl glsl = {"own.glsl", "there", 1, 0};
    const field *node = field_user(effect_memory(s->e), &glsl, (const field *[FIELD_MAX_ARGS]){0});
    ok(node);
    pass *p = add_march(s, NULL);
    ok(pass_set_field(p, "radiance", node));
    set_output(s, p);
    assert_false(effect_check(s->e));
    assert_error("march: ");
    assert_error("there");
}

static void shadows_by_maps_want_maps(void **state) {
    stage *s = *state;
    pass *solid = effect_add_pass(s->e, "geometry", NULL, NULL);
    pass *p = effect_add_pass(s->e, "shade", NULL, NULL);
    assert_non_null(solid);
    assert_non_null(p);
    pass_add_source(p, solid);
    ok(pass_set_option(p, "shadows_by", "maps"));
    assert_false(pass_declare(p));
    assert_error("shade: 'shadows_by' asks for maps");
}

static void missing_files_are_named(void **state) {
    stage *s = *state;
    assert_null(effect_add_pass(s->e, NULL, "absent.comp", NULL));
    assert_error("absent.comp");
    assert_null(effect_add_pass(s->e, NULL, "../outside.comp", NULL));
    assert_null(effect_add_mesh(s->e, "absent.obj"));
    assert_error("absent.obj");
    assert_null(effect_add_mesh(s->e, "../../etc/passwd"));
    assert_null(effect_add_pass(s->e, "mrach", NULL, NULL));
    assert_string_equal(err_get(), "unknown pass 'mrach'; did you mean 'march'?");
    assert_int_equal(effect_pass_count(s->e), 0);
}

static void needed_field_or_image_that_is_missing_is_named(void **state) {
    stage *s = *state;
    pass *march = effect_add_pass(s->e, "march", NULL, NULL);
    ok(march);
    assert_false(pass_declare(march));
    assert_error("march: field 'density' is missing");
    pass *over = effect_add_pass(s->e, "over", NULL, "laid");
    ok(over);
    assert_false(pass_declare(over));
    assert_error("laid: input 'volume' is missing");
}

// ---- outputs ------------------------------------------------------------------------------------

static void effect_without_output_is_refused(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    assert_false(effect_check(s->e));
    assert_error("test.lua: the effect has no output");
}

static void volume_is_no_picture(void **state) {
    stage *s = *state;
    field_grid *grid =
        add_bake(s->e, ball(s), (uint32_t[3]){4, 4, 4}, (box3){{-1, -1, -1}, {1, 1, 1}});
    ok(grid);
    graph_image volume = pass_output(effect_get_pass(s->e, 0), "values");
    assert_true(volume.id != 0);
    assert_false(effect_set_picture(s->e, EFFECT_OUTPUT, volume));
    assert_error("the picture of an effect is 2D");
    pass *final = effect_add_pass(s->e, "final", NULL, NULL);
    ok(final);
    assert_false(pass_set_image(final, "source", volume));
    assert_error("final: input 'source' takes a 2D image");
}

// ---- labels, timeline, bakes --------------------------------------------------------------------

static void labels_are_unique_names(void **state) {
    stage *s = *state;
    ok(effect_add_pass(s->e, "march", NULL, "smoke"));
    assert_null(effect_add_pass(s->e, "march", NULL, "smoke"));
    assert_error("pass name 'smoke' is taken");
    assert_null(effect_add_pass(s->e, "march", NULL, "two words"));
    assert_error("pass name 'two words' is not a name");
    ok(effect_add_pass(s->e, "march", NULL, "march_2"));
    ok(effect_add_pass(s->e, "march", NULL, NULL));
    pass *p = effect_add_pass(s->e, "march", NULL, NULL); // march_2 is taken by then
    ok(p);
    assert_string_equal(pass_label(p), "march_3");
}

static void timeline_has_limits(void **state) {
    stage *s = *state;
    assert_true(effect_get_facts(s->e)->fps == 24 && effect_get_facts(s->e)->frames == 1);
    assert_int_equal(effect_get_facts(s->e)->first, 1);
    ok(effect_set_timeline(s->e, 29.97, 240, 1001));
    assert_true(effect_get_facts(s->e)->fps == 29.97 && effect_get_facts(s->e)->frames == 240);
    assert_int_equal(effect_get_facts(s->e)->first, 1001);
    const double rates[] = {0, -24, 1001, (double)NAN, (double)INFINITY};
    for (size_t i = 0; i < COUNT_OF(rates); i++) {
        assert_false(effect_set_timeline(s->e, rates[i], 10, 1));
        assert_error("accepted: above 0, up to 1000");
    }
    assert_false(effect_set_timeline(s->e, 24, 0, 1));
    assert_error("frames is 0; accepted: 1 to 1000000");
    assert_false(effect_set_timeline(s->e, 24, 1000001, 1));
    assert_true(effect_get_facts(s->e)->fps == 29.97 && effect_get_facts(s->e)->frames == 240);
}

static void bake_has_limits(void **state) {
    stage *s = *state;
    const box3 box = {{-1, -1, -1}, {1, 1, 1}};
    const uint32_t sizes[][3] = {{0, 8, 8}, {8, 1025, 8}, {8, 8, UINT32_MAX}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        assert_null(add_bake(s->e, ball(s), sizes[i], box));
        assert_error("accepted: 1 to 1024 each");
    }
    assert_null(add_bake(s->e, ball(s), (uint32_t[3]){1024, 1024, 1024}, box));
    assert_error("at most 134217728");
    const uint32_t size[3] = {8, 8, 8};
    assert_null(add_bake(s->e, ball(s), size, box3_infinite()));
    assert_error("no finite bounds");
    assert_null(add_bake(s->e, ball(s), size, box3_empty()));
    assert_null(add_bake(s->e, ball(s), size, (box3){{0, 0, 0}, {1, 1, NAN}}));
    const effect_bake_desc levels = {.size = {8, 8, 8}, .box = box, .levels = true};
    assert_null(effect_add_bake(s->e, ball(s), &levels));
    assert_error("'levels' is for a grid that repeats");
    assert_int_equal(effect_pass_count(s->e), 0);
}

static void meshes_go_to_geometry_only(void **state) {
    stage *s = *state;
    write_file(s, "one.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    scene_mesh *mesh = effect_add_mesh(s->e, "one.obj");
    ok(mesh);
    pass *geometry = effect_add_pass(s->e, "geometry", NULL, NULL), *march = add_march(s, NULL);
    ok(geometry && pass_add_mesh(geometry, mesh));
    assert_false(pass_add_mesh(march, mesh));
    assert_error("march: takes no meshes; pass them to geometry");
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        STAGE_TEST(effect_of_all_built_in_passes_is_sound),
        STAGE_TEST(volume_in_other_units_is_told_of),
        STAGE_TEST(mistake_in_a_users_shader_is_found_without_a_device),
        STAGE_TEST(mistake_in_an_annotation_is_found_when_the_pass_is_added),
        STAGE_TEST(users_function_that_is_not_there_is_found),
        STAGE_TEST(shadows_by_maps_want_maps),
        STAGE_TEST(missing_files_are_named),
        STAGE_TEST(needed_field_or_image_that_is_missing_is_named),
        STAGE_TEST(effect_without_output_is_refused),
        STAGE_TEST(volume_is_no_picture),
        STAGE_TEST(labels_are_unique_names),
        STAGE_TEST(timeline_has_limits),
        STAGE_TEST(bake_has_limits),
        STAGE_TEST(meshes_go_to_geometry_only),
    };
    isolate_warm_up("glsl"); // as the program does
    return cmocka_run_group_tests(tests, NULL, NULL);
}
