// Sweeps: what a file becomes, and what is refused.
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "script/sweep.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[PATH_CAP], outside[PATH_CAP];

static void put(const char *in, const char *name, const char *text) {
    char path[PATH_CAP];
    assert_true(path_join(path, in, name));
    assert_true(file_make_parent_folders(path));
    assert_true(file_write(path, text, strlen(text)));
}

static sweep_options plain(void) {
    return (sweep_options){.warmup = -1, .repeats = -1, .limit = -1, .settle = -1};
}

static bool read_with(const char *text, const sweep_options *options, arena *memory, sweep *out) {
    char path[PATH_CAP];
    put(folder, "s.lua", text);
    assert_true(path_join(path, folder, "s.lua"));
    return sweep_read(path, options, memory, out);
}

static sweep read_text(const char *text, arena *memory) {
    sweep s;
    sweep_options options = plain();
    if (!read_with(text, &options, memory, &s)) fail_msg("%s\n  in: %s", err_get(), text);
    return s;
}

// Labels of all rows, each followed by '|'.
static void labels_are(const char *text, const char *expected) {
    arena memory = {0};
    sweep s = read_text(text, &memory);
    strbuf found = {0};
    for (size_t i = 0; i < s.row_count; i++) strbuf_add(&found, "%s|", s.rows[i].label);
    assert_string_equal(strbuf_text(&found), expected);
    strbuf_free(&found);
    arena_free(&memory);
}

static const char *setting(const sweep_row *row, const char *name) {
    for (size_t i = 0; i < row->setting_count; i++)
        if (strcmp(row->settings[i].name, name) == 0) return row->settings[i].text;
    return "";
}

#define HEAD "return sweep { name = 'n', effect = 'puff.lua', frames = '2-4', "

static void axes_are_crossed(void **state) {
    (void)state;
    labels_are(HEAD "axes = { axis { 'steps', 16, 32 }, axis { 'noise', 'perlin', 'worley' } } }",
               "steps 16, perlin|steps 16, worley|steps 32, perlin|steps 32, worley|");
    labels_are(HEAD "axes = { axis { 'a.b', 0.5, true, label = 'x' } } }", "x 0.5|x true|");
    labels_are(HEAD
               "axes = { axis { 'size', {96, 54}, {48, 27} }, axis { 'effect', 'puff.lua' } } }",
               "96x54, puff|48x27, puff|");
    labels_are(HEAD "axes = { axis { 'frames', 3, '5-7' }, axis { 'wind', {1, 0, 2} } } }",
               "frames 3, wind 1,0,2|frames 5-7, wind 1,0,2|");
    labels_are(HEAD "}", "n|");
}

static void zipped_axes_go_together(void **state) {
    (void)state;
    labels_are(HEAD
               "axes = { zip { axis { 'a', 1, 2 }, axis { 'b', 3, 4 } }, axis { 'c', 5, 6 } } }",
               "a 1, b 3, c 5|a 1, b 3, c 6|a 2, b 4, c 5|a 2, b 4, c 6|");
}

static void rows_can_be_skipped(void **state) {
    (void)state;
    labels_are(HEAD
               "axes = { axis { 'a', 1, 2, 3 }, axis { 'm.b', 'x', 'y', label = 'b' } }, "
               "skip = function(row) return row.a == 2 or row.b == 'x' and row['m.b'] == 'x' end }",
               "a 1, y|a 3, y|");
}

static void a_row_has_all_that_is_said(void **state) {
    (void)state;
    arena memory = {0};
    sweep s = read_text(
        "return sweep { name = 'n', title = 'T', notes = { 'one', 'two' }, effect = 'puff.lua', "
        "size = {640, 360}, time = {1, 1.5}, warmup = 3, repeats = 2, limit = 9, settle = 0, "
        "compare = 2, counters = false, set = { opacity = 20, ['camera.eye'] = {1, 2, 3} }, "
        "axes = { axis { 'how', { name = 'coarse', steps = 16, size = {64, 36}, frames = {5, 9}, "
        "set = { size = 2 } }, { name = 'fine', opacity = 30 } } } }",
        &memory);
    assert_string_equal(s.title, "T");
    assert_int_equal(s.note_count, 2);
    assert_true(s.settle == 0 && s.compared == 2 && !s.counters);
    assert_int_equal(s.row_count, 2);
    const sweep_row *coarse = &s.rows[0], *fine = &s.rows[1];
    assert_string_equal(coarse->label, "coarse");
    assert_true(coarse->width == 64 && coarse->height == 36 && coarse->frame_count == 2);
    assert_true(coarse->frames[1] == 9 && coarse->first == coarse->last);
    assert_string_equal(setting(coarse, "steps"), "16");
    assert_string_equal(setting(coarse, "size"), "2");
    assert_string_equal(setting(coarse, "opacity"), "20");
    assert_string_equal(setting(coarse, "camera.eye"), "1,2,3");
    assert_string_equal(setting(fine, "opacity"), "30");
    assert_true(fine->width == 640 && !fine->frames && fine->first == 1 && fine->last == 1.5);
    assert_true(fine->warmup == 3 && fine->repeats == 2 && fine->limit == 9);
    assert_true(fine->reference == SWEEP_NO_REFERENCE);
    assert_string_equal(path_name(fine->effect), "puff.lua");
    arena_free(&memory);
}

static void references_are_shared(void **state) {
    (void)state;
    arena memory = {0};
    sweep s =
        read_text(HEAD "axes = { axis { 'steps', 16, 32 }, axis { 'm.r', 1, 2, label = 'r' }, "
                       "axis { 'noise', 'p', 'w' } }, reference = { steps = 99, r = 2 } }",
                  &memory);
    assert_int_equal(s.reference_count, 2);
    assert_int_equal(s.samples, 0);
    for (size_t i = 0; i < s.row_count; i++) {
        const sweep_row *reference = &s.references[s.rows[i].reference];
        assert_string_equal(setting(reference, "steps"), "99");
        assert_string_equal(setting(reference, "m.r"), "2");
        assert_string_equal(setting(reference, "noise"), setting(&s.rows[i], "noise"));
    }
    s = read_text(HEAD "axes = { axis { 'part', { name = 'all' }, { name = 'less', a = 1 } } }, "
                       "reference = { samples = 64, part = 'all' } }",
                  &memory);
    assert_int_equal(s.reference_count, 1);
    assert_int_equal(s.samples, 64);
    assert_string_equal(setting(&s.references[0], "a"), "");
    arena_free(&memory);
}

static void published_figures_are_asked_for(void **state) {
    (void)state;
    arena memory = {0};
    sweep s = read_text(
        HEAD "axes = { axis { 'a', 1, 2 } }, "
             "published = function(row) return row.a == 2 and { card = 7.5 } or nil end }",
        &memory);
    assert_int_equal(s.rows[0].published_count, 0);
    assert_int_equal(s.rows[1].published_count, 1);
    assert_string_equal(s.rows[1].published[0].name, "card");
    assert_true(s.rows[1].published[0].value == 7.5);
    arena_free(&memory);
}

static void the_command_line_wins(void **state) {
    (void)state;
    arena memory = {0};
    sweep s;
    double frames[] = {7};
    sweep_options options = {.width = 100,
                             .height = 50,
                             .frames = frames,
                             .frame_count = 1,
                             .warmup = 0,
                             .repeats = 4,
                             .limit = 2,
                             .settle = 0.5};
    assert_true(read_with(HEAD "warmup = 9, axes = { axis { 'size', {400, 200}, {200, 100} } }, "
                               "skip = function(row) return row.size == '400x200' end }",
                          &options, &memory, &s));
    assert_int_equal(s.row_count, 1);
    assert_true(s.rows[0].width == 50 && s.rows[0].height == 25);
    assert_string_equal(s.rows[0].label, "50x25");
    assert_string_equal(s.axes[0].values[0], "100x50");
    assert_true(s.rows[0].frame_count == 1 && s.rows[0].frames[0] == 7);
    assert_true(s.rows[0].warmup == 0 && s.rows[0].repeats == 4 && s.rows[0].limit == 2);
    assert_true(s.settle == 0.5);
    assert_true(read_with(HEAD "axes = { axis { 'a', 1, 2 } } }", &options, &memory, &s));
    assert_true(s.rows[1].width == 100 && s.rows[1].height == 50);
    options.no_reference = true;
    assert_true(read_with(HEAD "reference = { samples = 4 } }", &options, &memory, &s));
    assert_true(s.reference_count == 0 && s.samples == 0);
    assert_true(s.rows[0].reference == SWEEP_NO_REFERENCE);
    arena_free(&memory);
}

static void other_measures_have_their_keys(void **state) {
    (void)state;
    arena memory = {0};
    sweep s =
        read_text("return sweep { name = 'n', effect = 'puff.lua', measure = 'reload', "
                  "axes = { axis { 'edit', { name = 'number', edit = {'1', '2', 'a\\nb'} } } } }",
                  &memory);
    assert_int_equal(s.measure, SWEEP_RELOAD);
    assert_int_equal(s.rows[0].edit_count, 3);
    assert_string_equal(s.rows[0].edits[2], "a\nb");
    s = read_text(
        "return sweep { name = 'n', effect = 'puff.lua', measure = 'start', "
        "axes = { axis { 'command', 'check', 'render' }, axis { 'cache', 'warm', 'empty' } } }",
        &memory);
    assert_string_equal(s.rows[3].command, "render");
    assert_true(s.rows[3].empty_cache && !s.rows[2].empty_cache);
    arena_free(&memory);
}

static void what_is_wrong_is_said(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"", "ends with return sweep { ... }"},
        {"return { }", "ends with return sweep { ... }"},
        {"return sweep { name = 'n' ", "s.lua:1:"},
        {"return sweep(3)", "sweep takes a table"},
        {"return sweep { }", "has no name"},
        {"return sweep { name = 'n', frames = 1 }", "no effect is named"},
        {"return sweep { name = 'n', effect = 'puff.lua' }", "which frames are drawn"},
        {"return sweep { name = 'n', efect = 'puff.lua' }", "did you mean 'effect'?"},
        {"return sweep { name = 'n', measure = 'frame' }", "did you mean 'frames'?"},
        {"return sweep { name = 'a\\nb', effect = 'puff.lua', frames = 1 }", "one line of text"},
        {"return sweep { name = 'n', effect = 'none.lua', frames = 1 }", "there is no file"},
        {HEAD "size = {0, 1} }", "'size' is 0"},
        {HEAD "size = 3 }", "'size' must be {width, height}"},
        {HEAD "warmup = 1.5 }", "a whole number"},
        {HEAD "repeats = 0 }", "'repeats' is 0"},
        {HEAD "time = {2, 1} }", "ends before it begins"},
        {HEAD "set = { 1 } }", "settings have names"},
        {HEAD "set = { ['a b'] = 1 } }", "no name of a setting"},
        {HEAD "set = { a = function() end } }", "'a' must be a number, true or false"},
        {HEAD "axes = { } }", "'axes' is a list"},
        {HEAD "axes = { 3 } }", "part 1 of 'axes' is no axis"},
        {HEAD "axes = { axis { 'a' } } }", "axis 'a': has no values"},
        {HEAD "axes = { axis { 'a', 1, 1 } } }", "has the value '1' twice"},
        {HEAD "axes = { axis { 1, 2 } } }", "begins with the name"},
        {HEAD "axes = { axis { 'a', 1, lable = 'x' } } }", "did you mean 'label'?"},
        {HEAD "axes = { axis { 'a', { steps = 1 } } } }", "has a name"},
        {HEAD "axes = { axis { 'a', 1 }, axis { 'a', 2 } } }", "the same name or label"},
        {HEAD "axes = { zip { axis { 'a', 1 }, axis { 'b', 1, 2 } } } }", "have as many"},
        {HEAD "axes = { zip { axis { 'a', 1 } } } }", "zip takes 2"},
        {HEAD "axes = { axis { 'cache', 'wram' } } }", "did you mean 'warm'?"},
        {HEAD "reference = { size = {1, 1} } }", "has the frames and the size of its row"},
        {HEAD "reference = { samples = 0 } }", "'samples' is 0"},
        {HEAD "axes = { axis { 'part', { name = 'all' } } }, reference = { part = 'al' } }",
         "did you mean 'all'?"},
        {HEAD "skip = 3 }", "'skip' is a function"},
        {HEAD "skip = function() return true end }", "leaves no row"},
        {HEAD "skip = function() error('mine') end }", "mine"},
        {HEAD "published = function() return 3 end }", "must return a table"},
        {HEAD "published = function() return { a = 'b' } end }", "'a' must be a number"},
        {HEAD "skip = function() while true do end end }", "instruction limit"},
        {"local s = 'x' while true do s = s .. s end", "memory limit of 4 MiB for one string"},
        {"return os.exit()", "os"},
        {"return io.open('/etc/passwd')", "io"},
        {HEAD "measure = 'reload', axes = { axis { 'a', 1 } } }", "nothing says what is edited"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        arena memory = {0};
        sweep s;
        sweep_options options = plain();
        if (read_with(cases[i][0], &options, &memory, &s)) fail_msg("%s was taken", cases[i][0]);
        if (!strstr(err_get(), cases[i][1]))
            fail_msg("%s: \"%s\" is not in: %s", cases[i][0], cases[i][1], err_get());
        arena_free(&memory);
    }
}

static void there_is_an_end_to_rows(void **state) {
    (void)state;
    arena memory = {0};
    sweep s;
    sweep_options options = plain();
    strbuf text = {0};
    strbuf_add(&text, HEAD "axes = { ");
    for (char axis = 'a'; axis < 'e'; axis++) {
        strbuf_add(&text, "axis { '%c'", axis);
        for (int i = 0; i < 10; i++) strbuf_add(&text, ", %d", i);
        strbuf_add(&text, " }, ");
    }
    strbuf_add(&text, "} }");
    assert_false(read_with(text.text, &options, &memory, &s));
    assert_non_null(strstr(err_get(), "more than 4096 rows"));
    strbuf_free(&text);
    arena_free(&memory);
}

static void effects_elsewhere_are_not_opened(void **state) {
    (void)state;
    char text[2 * PATH_CAP], path[PATH_CAP];
    arena memory = {0};
    sweep s;
    sweep_options options = plain();
    assert_true(path_join(path, outside, "other.lua"));
    snprintf(text, sizeof text, "return sweep { name = 'n', frames = 1, effect = '%s' }", path);
    assert_false(read_with(text, &options, &memory, &s));
    assert_non_null(strstr(err_get(), "lies neither in the sweep's folder nor in the current one"));
    options.home = outside; // the program's own
    assert_true(read_with(text, &options, &memory, &s));
    options.home = NULL;
    assert_int_equal(chdir(outside), 0); // the user's
    assert_true(read_with(text, &options, &memory, &s));
    assert_string_equal(s.rows[0].effect, "other.lua");
    char link[PATH_CAP];
    assert_int_equal(chdir("/"), 0);
    assert_true(path_join(link, folder, "link.lua"));
    assert_int_equal(symlink(path, link), 0);
    assert_int_equal(chdir(folder), 0);
    assert_false(read_with("return sweep { name = 'n', frames = 1, effect = 'link.lua' }", &options,
                           &memory, &s));
    assert_int_equal(unlink(link), 0);
    arena_free(&memory);
}

static int make_folders(void **state) {
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/roil-sweep-XXXXXX");
    snprintf(outside, sizeof outside, "/tmp/roil-other-XXXXXX");
    if (!mkdtemp(folder) || !mkdtemp(outside)) return -1;
    put(folder, "puff.lua", "");
    put(outside, "other.lua", "");
    return 0;
}

static int remove_folders(void **state) {
    (void)state;
    static const char *const names[] = {"puff.lua", "s.lua", "other.lua"};
    char path[PATH_CAP];
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        if (path_join(path, folder, names[i])) unlink(path);
        if (path_join(path, outside, names[i])) unlink(path);
    }
    return rmdir(folder) || rmdir(outside);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_are_crossed),
        cmocka_unit_test(zipped_axes_go_together),
        cmocka_unit_test(rows_can_be_skipped),
        cmocka_unit_test(a_row_has_all_that_is_said),
        cmocka_unit_test(references_are_shared),
        cmocka_unit_test(published_figures_are_asked_for),
        cmocka_unit_test(the_command_line_wins),
        cmocka_unit_test(other_measures_have_their_keys),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(there_is_an_end_to_rows),
        cmocka_unit_test(effects_elsewhere_are_not_opened),
    };
    return cmocka_run_group_tests(tests, make_folders, remove_folders);
}
