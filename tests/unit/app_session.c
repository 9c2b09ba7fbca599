// What the live window finds again: kept, partly kept, damaged, and nowhere to keep it.
#include "base_test.h"

#include "app/live.h"

static const live_session moved = {
    .x = -40,
    .y = 25,
    .width = 1234,
    .height = 777,
    .maximized = true,
    .panel = 512.5f,
    .panel_hidden = true,
    .performance = true,
    .inspector = true,
    .slices = true,
    .handles = true,
    .ground = true,
    .probe = true,
    .graph = true,
    .contrast = true,
    .scale = 1.5f,
    .image = "march.color",
    .preview = 2,
};

static int setup(void **state) {
    if (scratch_setup(state) != 0) return -1;
    return setenv("ROIL_STATE_DIR", *state, 1);
}

static void keep(const char *text) {
    char path[PATH_CAP];
    assert_true(session_file(path, sizeof path, "session.json"));
    assert_true(file_write(path, text, strlen(text)));
}

static void assert_defaults(const live_session *s) {
    assert_int_equal(s->width, 0);
    assert_int_equal(s->preview, -1);
    assert_true(s->panel > 200 && s->panel < 600);
    assert_false(s->maximized || s->panel_hidden || s->performance || s->inspector || s->slices);
    assert_false(s->handles || s->ground || s->probe || s->graph || s->contrast);
    assert_true(s->scale == 1);
    assert_string_equal(s->image, "");
}

static void what_is_kept_is_found(void **state) {
    (void)state;
    live_session s;
    session_save(&moved);
    session_load(&s);
    assert_int_equal(s.x, moved.x);
    assert_int_equal(s.y, moved.y);
    assert_int_equal(s.width, moved.width);
    assert_int_equal(s.height, moved.height);
    assert_true(s.panel == moved.panel);
    assert_true(s.maximized && s.panel_hidden && s.performance && s.inspector && s.slices);
    assert_true(s.handles && s.ground && s.probe && s.graph && s.contrast);
    assert_true(s.scale == moved.scale);
    assert_string_equal(s.image, moved.image);
    assert_int_equal(s.preview, moved.preview);
}

static void nothing_kept_gives_defaults(void **state) {
    (void)state;
    char path[PATH_CAP];
    live_session s;
    assert_true(session_file(path, sizeof path, "session.json"));
    unlink(path);
    session_load(&s);
    assert_defaults(&s);
}

static void damage_is_ignored(void **state) {
    (void)state;
    static const char *const texts[] = {
        "",
        "{",
        "[1, 2]",
        "\"width\"",
        "{\"width\": \"wide\", \"height\": null, \"panel\": {}, \"maximized\": 1, \"image\": 7}",
        "{\"width\": 1e99, \"height\": -3, \"panel\": 1e9, \"scale\": 99, \"preview\": 9}",
        "{\"width\": 800, \"height\": 0}",
        "{\"width\": NaN}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        live_session s = moved;
        keep(texts[i]);
        session_load(&s);
        assert_defaults(&s);
    }
}

static void what_is_valid_of_it_counts(void **state) {
    (void)state;
    live_session s;
    keep("{\"width\": 900, \"height\": 600, \"panel\": \"big\", \"performance\": true}");
    session_load(&s);
    assert_int_equal(s.width, 900);
    assert_int_equal(s.height, 600);
    assert_true(s.performance);
    assert_true(s.panel > 200 && s.panel < 600);
}

static void the_folder_follows_the_environment(void **state) {
    char path[PATH_CAP], expected[PATH_CAP];
    const char *folder = *state;
    unsetenv("ROIL_STATE_DIR");
    setenv("XDG_STATE_HOME", folder, 1);
    assert_true(session_file(path, sizeof path, "layout.ini"));
    snprintf(expected, sizeof expected, "%s/roil/layout.ini", folder);
    assert_string_equal(path, expected);
    unsetenv("XDG_STATE_HOME");
    setenv("HOME", folder, 1);
    assert_true(session_file(path, sizeof path, "layout.ini"));
    snprintf(expected, sizeof expected, "%s/.local/state/roil/layout.ini", folder);
    assert_string_equal(path, expected);
    unsetenv("HOME");
    assert_false(session_file(path, sizeof path, "layout.ini"));
    assert_message("XDG_STATE_HOME");
    setenv("ROIL_STATE_DIR", folder, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept_is_found),
        cmocka_unit_test(nothing_kept_gives_defaults),
        cmocka_unit_test(damage_is_ignored),
        cmocka_unit_test(what_is_valid_of_it_counts),
        cmocka_unit_test(the_folder_follows_the_environment),
    };
    return cmocka_run_group_tests(tests, setup, scratch_teardown);
}
