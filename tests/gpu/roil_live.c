// An effect that follows its files. Every test writes files as an editor does, waits for the
// background (no sleeps), takes over, draws, and looks at pixels.
#include "base/clock.h"
#include "roil_live_test.h"
#include <glob.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

// ---- edits ------------------------------------------------------------------------------------

static void number_edit_shows_and_the_simulation_goes_on(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    draw(&s, 2, 0.5, 0.25);
    put_script("0.75", "", "");
    expect_good(&s);
    draw(&s, 3, 0.75, 0.25);
    assert_false(update(&s)); // nothing new
    draw(&s, 4, 0.75, 0.25);
    roil_live_count counts = roil_live_counts(s.live);
    assert_true(counts.reloads == 2 && counts.failures == 0 && counts.last > 0);
    end(&s);
}

static void structural_edit_shows_and_the_simulation_goes_on(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put_script("0.25", "mode = 'double'", "");
    expect_good(&s);
    draw(&s, 2, 0.5, 0.25);
    end(&s);
}

static void module_edit_shows(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put("more.lua", "return 0.5");
    expect_good(&s);
    draw(&s, 2, 0.25, 0.25);
    end(&s);
}

static void edit_of_an_included_shader_shows(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put_part("0.75");
    expect_good(&s);
    draw(&s, 2, 0.5, 0.75);
    end(&s);
}

// Ends when the script that `edit` writes has said "busy" on stderr.
static void begin_build(void (*edit)(void)) {
    int ends[2], own = dup(2);
    char said[4096] = "";
    assert_true(own >= 0 && pipe(ends) == 0 && dup2(ends[1], 2) == 2);
    edit();
    for (size_t n = 0; !strstr(said, "busy") && n < sizeof said - 1;) {
        ssize_t got = read(ends[0], said + n, sizeof said - 1 - n);
        assert_true(got > 0);
        n += (size_t)got;
    }
    dup2(own, 2);
    close(own);
    close(ends[0]);
    close(ends[1]);
}

static void put_endless_module(void) {
    put("more.lua", "local s = ('x'):rep(1 << 22)\n"
                    "local a, b = s:sub(2), s:sub(2)\n"
                    "print('busy')\n"
                    "while true do local c = a < b end");
}

static void a_build_without_end_does_not_hold_up_the_end(void **state) {
    session s = begin(*state);
    begin_build(put_endless_module);
    double start = clock_seconds();
    assert_true(roil_live_destroy(s.live));
    double took = clock_seconds() - start;
    if (took > 3) fail_msg("took %g s", took);
}

// The process that compiles: the child of this one that has that name.
static pid_t find_reader(void) {
    glob_t processes;
    pid_t found = 0;
    assert_int_equal(glob("/proc/[0-9]*/stat", 0, NULL, &processes), 0);
    for (size_t i = 0; i < processes.gl_pathc && !found; i++) {
        int number, parent;
        FILE *f = fopen(processes.gl_pathv[i], "r");
        if (f && fscanf(f, "%d (roil-reader) %*c %d", &number, &parent) == 2 && parent == getpid())
            found = number;
        if (f) fclose(f);
    }
    globfree(&processes);
    assert_true(found > 0);
    return found;
}

static void put_what_no_cache_has(void) {
    char text[2048];
    snprintf(text, sizeof text, "%s// %.9f\nconst float new_ = %.9f;\n", SHADER, clock_seconds(),
             clock_seconds());
    put("new.comp", text);
    put_script("0.5", "", "print('busy')\nfx.linear = shader { 'new.comp' }.color");
}

// As where a file system or a driver hangs: the process that compiles stands still.
static void a_build_that_hangs_is_left_behind(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    pid_t reader = find_reader();
    assert_int_equal(kill(reader, SIGSTOP), 0);
    begin_build(put_what_no_cache_has);
    draw(&s, 2, 0.5, 0.25); // meanwhile
    double begun = clock_seconds();
    while (!roil_live_update(s.live, WIDTH, HEIGHT, s.frame)) { // after 10 s, when a file changes
        if (clock_seconds() > begun + 60) fail_msg("nobody left it behind");
        put_script("0.75", "", "");
        assert_int_equal(poll(NULL, 0, 250), 0);
    }
    const char *message = roil_live_message(s.live); // none: the next build was there as soon
    if (message && !strstr(message, "was abandoned")) fail_msg("%s", message);
    if (message) expect_good(&s);
    draw(&s, 3, 0.75, 0.25);
    assert_int_equal(kill(reader, SIGCONT), 0);
    assert_true(roil_live_destroy(s.live)); // waits for the one that was left
}

static const char MESH_SCRIPT[] = "local fx = effect { name = 'test' }\n"
                                  "fx.camera = camera { eye = {0, -5, 0}, target = {0, 0, 0} }\n"
                                  "local g = geometry { mesh { 'quad.obj' } }\n"
                                  "fx.output = g.albedo\n"
                                  "return fx\n";

static void put_quad(int size) {
    char text[256];
    snprintf(text, sizeof text,
             "v -%d 0 -%d\nv %d 0 -%d\nv %d 0 %d\nv -%d 0 %d\nf 1 2 3\nf 1 3 4\n", size, size, size,
             size, size, size, size, size);
    put("quad.obj", text);
}

static void draw_quad(session *s, bool expected) {
    static uint8_t pixels[WIDTH * HEIGHT * 4];
    ok(roil_render(roil_live_effect(s->live), s->frame++));
    ok(roil_read(roil_live_effect(s->live), false, pixels));
    const uint8_t *corner = pixels + 4 * (2 * WIDTH + WIDTH / 2); // near the upper edge
    assert_int_equal(corner[0] + corner[1] + corner[2] > 0, expected);
}

static void mesh_edit_shows(void **state) {
    session s = {.frame = 1};
    put_quad(1);
    write_text("mesh.lua", MESH_SCRIPT, script_path);
    s.live = roil_live_create(*state, &(roil_live_desc){.file = script_path});
    ok(s.live);
    expect_good(&s);
    draw_quad(&s, false);
    put_quad(3);
    expect_good(&s);
    draw_quad(&s, true);
    write_text("mesh.lua", MESH_SCRIPT, script_path); // the same again
    expect_good(&s);
    draw_quad(&s, true);
    end(&s);
}

// ---- what is broken ---------------------------------------------------------------------------

static void broken_file_keeps_the_old_effect(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put_script("0.5", "mode = 'tripel'", "");
    expect_broken(&s, "test.lua:4: ");
    assert_non_null(strstr(roil_live_message(s.live), "\n    local count = shader {"));
    draw(&s, 2, 0.5, 0.25);
    put_script("oops", "", "");
    expect_broken(&s, "test.lua:3: ");
    draw(&s, 3, 0.5, 0.25);
    put_script("0.75", "", "");
    expect_good(&s);
    draw(&s, 4, 0.75, 0.25);
    end(&s);
}

static void broken_shader_shows_its_line_with_a_caret(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put_part("misspelt");
    expect_broken(&s, "part.glsl:1: 'misspelt'");
    assert_non_null(strstr(roil_live_message(s.live), "\n    float part() { return misspelt; }\n"
                                                      "                          ^"));
    draw(&s, 2, 0.5, 0.25);
    put_part("0.5");
    expect_good(&s);
    draw(&s, 3, 0.5, 0.5);
    end(&s);
}

static void file_that_is_missing_is_waited_for(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put("count.comp", "#include \"later.glsl\"\n");
    expect_broken(&s, "later.glsl");
    put("count.comp", SHADER);
    expect_good(&s);
    char text[2048];
    snprintf(text, sizeof text, "#include \"later.glsl\"\n%s", SHADER);
    put("count.comp", text);
    expect_broken(&s, "later.glsl");
    put("later.glsl", "// no more than a comment\n");
    expect_good(&s);
    put("more.lua", "return require 'later'");
    expect_broken(&s, "no module 'later'");
    put("later.lua", "return 1");
    expect_good(&s);
    draw(&s, 2, 0.5, 0.25);
    end(&s);
}

static void deleted_file_is_waited_for(void **state) {
    session s = begin(*state);
    char shader[512];
    snprintf(shader, sizeof shader, "%s/count.comp", test_folder);
    draw(&s, 1, 0.5, 0.25);
    assert_int_equal(unlink(script_path), 0);
    expect_broken(&s, "test.lua");
    draw(&s, 2, 0.5, 0.25);
    assert_int_equal(unlink(shader), 0);
    roil_live_wait(s.live);
    put("count.comp", SHADER);
    put_script("1", "", "");
    expect_good(&s);
    draw(&s, 3, 1, 0.25);
    end(&s);
}

static void file_that_is_broken_from_the_start_is_followed(void **state) {
    put_all();
    put_script("", "", "");
    session s = {.frame = 1};
    s.live = roil_live_create(*state, &(roil_live_desc){.file = script_path});
    ok(s.live);
    expect_broken(&s, "test.lua:3: ");
    assert_null(roil_live_effect(s.live));
    put_script("1", "", "");
    expect_good(&s);
    draw(&s, 1, 1, 0.25);
    end(&s);
}

static void empty_file_is_no_news_until_it_stays_so(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    write_text("test.lua", "", script_path); // an editor between two writes
    put_script("1", "", "");
    expect_good(&s);
    draw(&s, 2, 1, 0.25);
    assert_int_equal(roil_live_counts(s.live).failures, 0);
    write_text("test.lua", "", script_path);
    expect_broken(&s, "no effect is declared");
    end(&s);
}

static void endless_update_is_not_taken(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    put_script("1", "", "fx.update = function(t, dt) while true do end end");
    expect_broken(&s, "test.lua:");
    draw(&s, 2, 0.5, 0.25);
    put_script("1", "", "fx.update = function(t, dt) end");
    expect_good(&s);
    draw(&s, 3, 1, 0.25);
    end(&s);
}

static void function_that_fails_at_the_frame_is_not_taken(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    s.frame = 30;
    update(&s);
    put_script("1", "gain = function(t) if t > 1 then error('late') end return 1 end", "");
    expect_broken(&s, "late");
    s.frame = 2;
    update(&s);
    put_script("1", " gain = function(t) if t > 1 then error('late') end return 1 end", "");
    expect_good(&s);
    end(&s);
}

// ---- settings ---------------------------------------------------------------------------------

static void moved_value_survives_an_edit(void **state) {
    session s = begin(*state);
    ok(roil_live_set(s.live, "gain", "1"));
    draw(&s, 1, 1, 0.25);
    put_script("0.5", "", "-- a comment");
    expect_good(&s);
    draw(&s, 2, 1, 0.25);
    ok(roil_live_reset(s.live, "gain"));
    draw(&s, 3, 0.5, 0.25);
    put_script("0.5", "", "");
    expect_good(&s);
    draw(&s, 4, 0.5, 0.25);
    end(&s);
}

// Draws a field whose number is `radius` with the effect at hand, and again loaded anew.
static void number_of_a_field_moves_in_place(void **state) {
    static uint8_t set[WIDTH * HEIGHT * 4], loaded[sizeof set], first[sizeof set];
    const char *text = "local fx = effect { }\n"
                       "local ball = sphere { radius = 0.5, falloff = 0.3 }\n"
                       "fx.camera = orbit { distance = 6 }\n"
                       "fx.output = final { march { density = ball * 9, emission = ball } }.color\n"
                       "return fx\n";
    char path[512];
    write_text("ball.lua", text, path);
    roil_effect *e = roil_load(*state, path, NULL, 0);
    ok(e && roil_prepare(e, WIDTH, HEIGHT) && roil_render(e, 1) && roil_read(e, false, first));
    ok(roil_set(e, "ball.radius", "1.5") && roil_render(e, 1) && roil_read(e, false, set));
    roil_effect *other = roil_load(*state, path, &(roil_setting){"ball.radius", "1.5"}, 1);
    ok(other && roil_prepare(other, WIDTH, HEIGHT) && roil_render(other, 1));
    ok(roil_read(other, false, loaded));
    assert_memory_equal(set, loaded, sizeof set);
    assert_true(memcmp(set, first, sizeof set) != 0);
    ok(roil_reset(e, "ball.radius") && roil_render(e, 1) && roil_read(e, false, set));
    assert_memory_equal(set, first, sizeof set);
    roil_unload(other);
    roil_unload(e);
}

static void moved_value_yields_to_a_changed_default(void **state) {
    session s = begin(*state);
    ok(roil_live_set(s.live, "gain", "1"));
    put_script("0.25", "", "");
    expect_good(&s);
    draw(&s, 1, 0.25, 0.25);
    put_script("0.5", "", ""); // and is forgotten
    expect_good(&s);
    draw(&s, 2, 0.5, 0.25);
    end(&s);
}

static void setting_during_a_build_is_not_lost(void **state) {
    session s = begin(*state);
    put_script("0.5", "", "-- a comment");
    roil_live_wait(s.live); // built, and not taken yet
    ok(roil_live_set(s.live, "gain", "1"));
    expect_good(&s);
    draw(&s, 1, 1, 0.25);
    put_script("0.5", "", "");
    roil_live_wait(s.live);
    ok(roil_live_reset(s.live, NULL));
    expect_good(&s);
    draw(&s, 2, 0.5, 0.25);
    end(&s);
}

static void structure_is_set_by_a_build(void **state) {
    session s = begin(*state);
    draw(&s, 1, 0.5, 0.25);
    ok(roil_live_set(s.live, "count.mode", "double"));
    expect_good(&s);
    draw(&s, 2, 1, 0.25);
    put_script("0.25", "", "");
    expect_good(&s);
    draw(&s, 3, 0.5, 0.25);
    assert_false(roil_live_set(s.live, "count.mode", "triple"));
    assert_non_null(strstr(roil_error(), "plain, double"));
    assert_false(roil_live_set(s.live, "count.mod", "plain"));
    ok(roil_live_reset(s.live, "count.mode"));
    expect_good(&s);
    draw(&s, 4, 0.25, 0.25);
    end(&s);
}

static void setting_of_the_command_line_holds(void **state) {
    session s = begin_with(*state, (roil_setting[]){{"gain", "1"}}, 1);
    expect_good(&s);
    draw(&s, 1, 1, 0.25);
    put_script("0.25", "", "");
    expect_good(&s);
    draw(&s, 2, 1, 0.25);
    ok(roil_live_set(s.live, "gain", "0.75")); // until it is moved
    put_script("0.5", "", "");
    expect_good(&s);
    draw(&s, 3, 0.5, 0.25);
    end(&s);
}

// A preset is followed like the script; what is moved or reset by hand wins over it.
static void preset_is_followed(void **state) {
    put_all();
    put("test.presets/half.lua", "return { gain = 0.25 }");
    session s = {.frame = 1};
    s.live = roil_live_create(*state, &(roil_live_desc){.file = script_path,
                                                        .presets = (const char *[]){"half"},
                                                        .preset_count = 1});
    ok(s.live);
    expect_good(&s);
    draw(&s, 1, 0.25, 0.25);
    put("test.presets/half.lua", "return { gain = 0.75 }");
    expect_good(&s);
    draw(&s, 2, 0.75, 0.25);
    put("test.presets/half.lua", "return { gian = 0.75 }");
    expect_broken(&s, "did you mean 'gain'?");
    put("test.presets/half.lua", "return { gain = ");
    expect_broken(&s, "half.lua:1: ");
    draw(&s, 3, 0.75, 0.25);
    put("test.presets/half.lua", "return {}"); // what it said before is forgotten
    expect_good(&s);
    draw(&s, 4, 0.5, 0.25);
    put("test.presets/half.lua", "return { gain = 1 }");
    expect_good(&s);
    ok(roil_live_reset(s.live, NULL));
    draw(&s, 5, 0.5, 0.25);
    put_script("0.5", "", "-- a comment");
    expect_good(&s);
    draw(&s, 6, 0.5, 0.25);
    end(&s);
}

// ---- memory -----------------------------------------------------------------------------------

enum { LARGE_WIDTH = 4096, LARGE_HEIGHT = 2048 }; // two images of 64 MiB, for the history

static bool update_large(session *s) {
    roil_live_wait(s->live);
    return roil_live_update(s->live, LARGE_WIDTH, LARGE_HEIGHT, s->frame);
}

static void expect_large(session *s, const char *trouble) {
    assert_true(update_large(s));
    const char *message = roil_live_message(s->live);
    if (!trouble && message) fail_msg("%s", message);
    if (trouble && !(message && strstr(message, trouble)))
        fail_msg("'%s' does not say '%s'", message ? message : "(no message)", trouble);
    roil_effect *e = roil_live_effect(s->live);
    assert_non_null(e);
    for (int i = 0; i < 6; i++) // until no frame in flight holds what was let go
        ok(roil_advance(e, s->frame++));
}

// What may be taken beside what is: as if whoever runs the program had said so from the start.
static void allow(roil *r, unsigned mebibytes) {
    char text[32];
    snprintf(text, sizeof text, "%llum",
             (unsigned long long)(roil_get_memory(r).sum >> 20) + mebibytes);
    roil *other = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .no_device = true, .memory = text});
    ok(other);
    roil_destroy(other);
}

static int allow_as_ever(void **state) {
    (void)state;
    roil *other = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .no_device = true, .memory = "60%"});
    roil_destroy(other);
    return other ? 0 : 1;
}

// A reload whose images cannot be taken over has both for a moment. That is no reason to refuse
// it; that it alone wants more than it may is.
static void reload_needs_no_room_for_the_old_effect(void **state) {
    put_all();
    session s = {.frame = 1};
    s.live = roil_live_create(*state, &(roil_live_desc){.file = script_path});
    ok(s.live);
    expect_large(&s, NULL);
    assert_true(roil_get_memory(*state).largest[0].bytes >= UINT64_C(64) << 20);
    allow(*state, 16);
    put_script("0.5", "name = 'renamed'", "");
    expect_large(&s, NULL);
    put_script("0.5", "name = 'renamed'",
               "fx.linear = shader { 'count.comp', name = 'more', gain = 1 }.color");
    expect_large(&s, "--memory");
    put_script("0.25", "name = 'again'", "");
    expect_large(&s, NULL);
    assert_int_equal(roil_live_counts(s.live).failures, 1);
    end(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(reload_needs_no_room_for_the_old_effect, allow_as_ever),
        cmocka_unit_test(preset_is_followed),
        cmocka_unit_test(number_of_a_field_moves_in_place),
        cmocka_unit_test(number_edit_shows_and_the_simulation_goes_on),
        cmocka_unit_test(structural_edit_shows_and_the_simulation_goes_on),
        cmocka_unit_test(module_edit_shows),
        cmocka_unit_test(edit_of_an_included_shader_shows),
        cmocka_unit_test(mesh_edit_shows),
        cmocka_unit_test(broken_file_keeps_the_old_effect),
        cmocka_unit_test(broken_shader_shows_its_line_with_a_caret),
        cmocka_unit_test(file_that_is_missing_is_waited_for),
        cmocka_unit_test(deleted_file_is_waited_for),
        cmocka_unit_test(file_that_is_broken_from_the_start_is_followed),
        cmocka_unit_test(empty_file_is_no_news_until_it_stays_so),
        cmocka_unit_test(endless_update_is_not_taken),
        cmocka_unit_test(function_that_fails_at_the_frame_is_not_taken),
        cmocka_unit_test(moved_value_survives_an_edit),
        cmocka_unit_test(moved_value_yields_to_a_changed_default),
        cmocka_unit_test(setting_during_a_build_is_not_lost),
        cmocka_unit_test(structure_is_set_by_a_build),
        cmocka_unit_test(a_build_without_end_does_not_hold_up_the_end),
        cmocka_unit_test(a_build_that_hangs_is_left_behind),
        cmocka_unit_test(setting_of_the_command_line_holds),
    };
    return test_run(tests);
}
