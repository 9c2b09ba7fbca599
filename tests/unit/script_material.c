// Materials as an effect file says them, and what of it reaches a mesh.
#include "media/png.h"
#include "scene/material.h"
#include "script_helper.h"
#include <math.h>

#define HEAD "local fx = effect { name = 'materials' }\n"
#define TAIL "\nfx.output = final { shade { from = geometry { m } } }.color\nreturn fx\n"

static effect *load(const char *text) {
    effect *e = helper_load(text);
    if (!e) fail_msg("%s", err_get());
    return e;
}

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static const scene_mesh *mesh_of(effect *e) {
    for (size_t i = 0; i < effect_pass_count(e); i++) {
        scene_mesh *const *meshes;
        if (pass_is(effect_get_pass(e, i), "geometry") &&
            pass_meshes(effect_get_pass(e, i), &meshes) > 0)
            return meshes[0];
    }
    fail_msg("no mesh");
    return NULL;
}

static scene_look look_at(effect *e, double time, float surface[4], float emission[4]) {
    field_context context = *effect_pass_host(e)->context;
    context.time = time;
    scene_look look;
    const scene_mesh *mesh = mesh_of(e);
    if (!scene_mesh_look(mesh, &context, &look)) fail_msg("%s", err_get());
    scene_look_part(&look, &mesh->data.parts[0], surface, emission);
    return look;
}

static bool near(float a, float b) {
    return fabsf(a - b) < 1e-5f;
}

static void what_is_not_said_is_as_the_file_has_it(void **state) {
    (void)state;
    float s[4], emission[4];
    effect *e =
        load(HEAD "local m = mesh { 'm.obj', material = material { roughness = 0.25 } }" TAIL);
    scene_look look = look_at(e, 0, s, emission);
    assert_true(near(look.tint[0], 1) && near(mesh_of(e)->data.parts[0].color[1], 0.4f));
    assert_true(near(s[0], 0.5f) && near(s[1], 0.25f) && s[2] == 0 && s[3] == 1);
    assert_true(near(emission[0], 3));
    assert_false(scene_mesh_is_matte(mesh_of(e)));
    effect_destroy(e);
}

static void numbers_move_and_stay_in_their_range(void **state) {
    (void)state;
    float s[4], emission[4];
    effect *e = load(
        HEAD "local m = mesh { 'm.obj', color = {2, 1, 1}, material = material {\n"
             "  color = function(t) return {t, 0.5, 0} end, metallic = function(t) return t end,\n"
             "  emission = function(t) return {-t, t, 1e9} end, toon = false } }" TAIL);
    scene_look look = look_at(e, 3, s, emission);
    assert_true(near(look.tint[0], 6) && near(look.tint[1], 0.5f));
    assert_true(near(mesh_of(e)->data.parts[0].color[1], 1)); // the field stands for it
    assert_true(s[2] == 1 && s[3] == 0);
    assert_true(emission[0] == 0 && emission[1] == 3 && emission[2] == 1e4f);
    effect_destroy(e);
}

static void a_texture_replaces_that_of_the_file(void **state) {
    (void)state;
    char path[PATH_CAP];
    static const uint8_t texels[4 * 3] = {255};
    path_join(path, helper_folder, "t.png");
    assert_true(png_write(path, &(png_image){2, 2, 3, 8, texels}, NULL, 0));
    effect *e =
        load(HEAD "local m = mesh { 'm.obj', material = material { texture = 't.png' } }" TAIL);
    const mesh_data *data = &mesh_of(e)->data;
    assert_int_equal(data->texture_count, 1);
    assert_int_equal(data->textures[0].width, 2);
    assert_int_equal(data->parts[0].texture, 0);
    effect_destroy(e);
}

static void a_named_number_can_be_set(void **state) {
    (void)state;
    effect *e = load(HEAD "local rust = material { metallic = 0, color = '#804020' }\n"
                          "local m = mesh { 'm.obj', material = rust }" TAIL);
    float s[4], emission[4];
    assert_true(effect_check_settings(e) && effect_set(e, "rust.metallic", "0.75"));
    assert_false(effect_set(e, "rust.roughness", "0.75")); // nothing is said of it
    look_at(e, 0, s, emission);
    assert_true(near(s[2], 0.75f));
    effect_destroy(e);
}

static void mistakes_have_messages(void **state) {
    (void)state;
    refused("local m = mesh { 'm.obj', material = 'rust' }", "takes material { }");
    refused("local m = mesh { 'm.obj', material = material { rough = 1 } }", "roughness");
    refused("local m = mesh { 'm.obj', material = material { texture = 'absent.png' } }",
            "absent.png");
    refused("local m = mesh { 'm.obj', material = material { texture = '../t.png' } }", "t.png");
    refused("local m = mesh { 'm.obj', material = material { specular = perlin { } } }",
            "varies in space");
    refused("local m = material { 1 }", "only named values");
    refused("local m = material { roughness = 3 }", "'roughness' is 3; accepted: 0 to 1");
    refused("local m = material { emission = {1, -1, 0} }",
            "'emission' is -1; accepted: 0 or more");
}

static int setup(void **state) {
    int result = helper_setup(state);
    helper_put("m.mtl", "newmtl m\nKd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nNs 100\nKe 3 2 1\n");
    helper_put("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    return result;
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_said_is_as_the_file_has_it),
        cmocka_unit_test(numbers_move_and_stay_in_their_range),
        cmocka_unit_test(a_texture_replaces_that_of_the_file),
        cmocka_unit_test(a_named_number_can_be_set),
        cmocka_unit_test(mistakes_have_messages),
    };
    return cmocka_run_group_tests(tests, setup, helper_teardown);
}
