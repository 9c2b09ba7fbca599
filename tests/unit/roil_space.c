// Where things are in space, through roil.h, and what moves them.
#include "roil_helper.h"

static const char script_text[] =
    "local fx = effect { fps = 10, frames = 50 }\n"
    "local place = param { 'place', {1, 2, 3}, min = -4, max = 4, unit = 'm' }\n"
    "local reach = param { 'reach', 2, unit = 'm' }\n"
    "local way = curve { {0, {0, 0, 0}}, {2, {4, 0, 2}}, shape = 'linear' }\n"
    "fx.camera = camera { eye = curve { name = 'flight', {0, {0, -8, 1}}, {4, {8, 0, 1}} }, target "
    "= {0, 0, 1} }\n"
    "fx.sun = sun { azimuth = 350, elevation = 30 }\n"
    "local lamp = spot_light { position = {1, 0, 3}, target = {0, 0, 1}, radius = 0.25 }\n"
    "fx.lights = { lamp, point_light { name = 'spark', position = way } }\n"
    "local ball = sphere { position = {0, 0, 1}, radius = 0.5 }\n"
    "local given = sphere { position = place, radius = reach }\n"
    "local made = sphere { position = vec(0, 0, reach), radius = 1 }\n"
    "local crate = box { position = {0, 1, 0}, size = {1, 2, 4} }\n"
    "local pill = capsule { from = {0, 0, 0}, to = {0, 0, 2}, radius = 0.5 }\n"
    "local stand = node { position = {0, 0, 1}, rotation = {0, 0, 90}, scale = 2 }\n"
    "local rock = mesh { 'rock.obj', position = {1, 0, 0}, parent = stand }\n"
    "local air = lbm { size = {16, 16, 16}, voxel_size = 0.25, position = {1, 0, 0} }\n"
    "local m = march { density = ball + given + made + crate + pill + air.density }\n"
    "fx.output = final { over { m, shade { from = { geometry { rock } } } } }.color\n";

static roil_effect *open(const roil_setting *settings, size_t count) {
    helper_put("rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return roil_open(script_text, settings, count);
}

static size_t find(roil_effect *e, const char *name, const char *part, roil_handle *out) {
    static roil_handle all[64];
    size_t count = roil_handles(e, all, 64);
    assert_true(count <= 64);
    for (size_t i = 0; i < count; i++) {
        *out = all[i];
        if (strcmp(out->name, name) == 0 && strcmp(out->part, part) == 0) return i;
    }
    fail_msg("there is no %s.%s", name, part);
    return 0;
}

static void is_at(const roil_handle *h, float x, float y, float z) {
    assert_float_equal(h->at[0], x, 1e-5f);
    assert_float_equal(h->at[1], y, 1e-5f);
    assert_float_equal(h->at[2], z, 1e-5f);
}

static void is_moved_by(const roil_handle *h, const char *control) {
    assert_non_null(h->control);
    assert_string_equal(h->control, control);
}

// Moves a point, and looks where it then is.
static void move(roil_effect *e, const char *name, const char *part, const float at[3]) {
    roil_handle h;
    size_t index = find(e, name, part, &h);
    char *text = roil_handle_text(e, index, false, at);
    need(text);
    need(roil_set(e, h.control, text));
    roil_free(text);
    find(e, name, part, &h);
    is_at(&h, at[0], at[1], at[2]);
}

static void things_are_listed_with_what_moves_them(void **state) {
    (void)state;
    roil_effect *e = open(NULL, 0);
    roil_handle h;
    find(e, "lamp", "position", &h);
    is_at(&h, 1, 0, 3);
    is_moved_by(&h, "lamp.position");
    assert_true(h.thing == ROIL_LIGHT && h.radius == 0.25f && !h.moves && !h.structural);
    find(e, "lamp", "target", &h);
    is_moved_by(&h, "lamp.target");
    find(e, "ball", "position", &h);
    is_moved_by(&h, "ball.position");
    find(e, "given", "position", &h); // a parameter's
    is_at(&h, 1, 2, 3);
    is_moved_by(&h, "place");
    find(e, "made", "position", &h); // computed
    is_at(&h, 0, 0, 2);
    assert_true(!h.control && h.moves);
    find(e, "stand", "position", &h);
    is_moved_by(&h, "stand.position");
    find(e, "rock", "position", &h); // turned and scaled by its node
    is_at(&h, -1, 3, 1);             // the middle of its box
    is_moved_by(&h, "rock.position");
    assert_float_equal(h.high[1], 4, 1e-5f);
    find(e, "air", "position", &h);
    is_at(&h, 1, 0, 0);
    is_moved_by(&h, "air.position");
    assert_true(h.structural && h.low[0] == -1 && h.high[2] == 4);
    roil_unload(e);
}

static void points_go_where_they_are_moved(void **state) {
    (void)state;
    roil_effect *e = open(NULL, 0);
    move(e, "lamp", "position", (const float[]){2, -1, 4});
    move(e, "lamp", "target", (const float[]){0.5f, 0, 0});
    move(e, "ball", "position", (const float[]){0, 0, 2});
    move(e, "ball", "radius", (const float[]){0.75f, 0, 2});
    move(e, "given", "position", (const float[]){3, 2, 1});
    move(e, "rock", "position", (const float[]){5, 6, 7});
    move(e, "stand", "position", (const float[]){1, 1, 1});
    move(e, "crate", "size", (const float[]){1, 2, 3});
    move(e, "pill", "to", (const float[]){1, 1, 1});
    roil_handle h;
    find(e, "ball", "position", &h);
    assert_float_equal(h.radius, 0.75f, 1e-6f);
    find(e, "crate", "position", &h);
    is_at(&h, 0, 1, 0);
    assert_true(h.high[1] == 2 && h.low[2] == -3);
    char *text = roil_control_text(e, "rock.position"); // in its node, which has moved since
    need(text);
    assert_string_equal(text, "2.5,-3,3");
    roil_free(text);
    size_t index = find(e, "given", "position", &h);
    text = roil_handle_text(e, index, false, (const float[]){9, 2, 1});
    assert_string_equal(text, "4,2,1"); // its range ends there
    roil_free(text);
    roil_unload(e);
}

static void sun_has_two_controls(void **state) {
    (void)state;
    roil_effect *e = open(NULL, 0);
    roil_handle h;
    size_t index = find(e, "sun", "direction", &h);
    assert_float_equal(glm_vec3_norm(h.at), 1, 1e-5f);
    is_moved_by(&h, "sun.azimuth");
    assert_string_equal(h.second, "sun.elevation");
    const float high = sinf(glm_rad(60)), wide = cosf(glm_rad(60));
    float at[3] = {wide * cosf(glm_rad(10)), wide * sinf(glm_rad(10)), high};
    char *azimuth = roil_handle_text(e, index, false, at);
    char *elevation = roil_handle_text(e, index, true, at);
    need(azimuth && elevation);
    assert_float_equal(strtof(azimuth, NULL), 360, 1e-3f); // of 370, as far as its range goes
    assert_float_equal(strtof(elevation, NULL), 60, 1e-3f);
    roil_free(azimuth);
    roil_free(elevation);
    roil_unload(e);
}

static void curves_are_paths_with_keys(void **state) {
    (void)state;
    roil_effect *e = open(NULL, 0);
    roil_handle h, eye;
    size_t index = find(e, "spark", "position", &h);
    assert_true(h.moves && !h.control);
    const double times[] = {0, 1, 2};
    float path[3][3];
    need(roil_handle_path(e, index, times, path, 3));
    assert_float_equal(path[1][0], 2, 1e-5f);
    assert_float_equal(path[2][2], 2, 1e-5f);
    find(e, "spark", "key", &h);
    is_moved_by(&h, "way");
    assert_int_equal(h.key, 0);
    char *text = roil_handle_text(e, index + 2, false, (const float[]){6, 0, 3});
    assert_string_equal(text, "linear 0 0,0,0; 2 6,0,3");
    need(roil_set(e, "way", text));
    roil_free(text);
    need(roil_handle_path(e, index, times, path, 3));
    assert_float_equal(path[2][0], 6, 1e-5f);
    // A window that looks from elsewhere shows where the script's camera flies.
    need(roil_set(e, "camera.eye", "20,20,20"));
    index = find(e, "camera", "position", &eye);
    is_at(&eye, 0, -8, 1);
    find(e, "camera", "key", &h);
    is_moved_by(&h, "flight");
    need(roil_handle_path(e, index, (const double[]){4}, path, 1));
    assert_float_equal(path[0][0], 8, 1e-4f);
    roil_unload(e);
}

static void boxes_of_volumes_are_set_by_a_load(void **state) {
    (void)state;
    roil_effect *e = open(&(roil_setting){"air.position", "0,0,2"}, 1);
    roil_handle h;
    find(e, "air", "position", &h);
    is_at(&h, 0, 0, 2);
    assert_true(h.low[0] == -2 && h.high[2] == 6);
    refused(roil_set(e, "air.position", "0,0,3"), "structure");
    roil_unload(e);
}

static void what_cannot_be_moved_says_so(void **state) {
    (void)state;
    roil_effect *e = open(NULL, 0);
    roil_handle h;
    size_t index = find(e, "made", "position", &h);
    refused(roil_handle_text(e, index, false, h.at), "made.position: no control moves it");
    refused(roil_handle_text(e, 1000, false, h.at), "there is no handle 1000");
    refused(roil_handle_path(e, 1000, NULL, NULL, 0), "there is no handle 1000");
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(things_are_listed_with_what_moves_them),
        cmocka_unit_test(points_go_where_they_are_moved),
        cmocka_unit_test(sun_has_two_controls),
        cmocka_unit_test(curves_are_paths_with_keys),
        cmocka_unit_test(boxes_of_volumes_are_set_by_a_load),
        cmocka_unit_test(what_cannot_be_moved_says_so),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
