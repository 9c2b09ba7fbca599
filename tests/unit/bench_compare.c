// Two runs compared, and rows chosen.
#include "bench_helper.h"

enum { MANY = 12 };

// Frames around `middle`, each `spread` from the next.
static void spread_values(double middle, double spread, double *out, size_t count) {
    for (size_t i = 0; i < count; i++)
        out[i] = middle + spread * ((double)i - (double)(count - 1) / 2);
}

static bench_change change_of(double before, double now, double spread, double shuffle,
                              size_t count) {
    double a[MANY], b[MANY];
    arena memory = {0};
    bench_results old, new;
    bench_change *changes;
    spread_values(before, spread, a, count);
    spread_values(now, spread, b, count);
    for (size_t i = 0; i < count; i++) b[i] += (i % 2 ? shuffle : -shuffle) * (double)(i / 2 + 1);
    helper_head(&old);
    helper_head(&new);
    bench_row row = helper_row(1, a, count, &memory);
    bench_add(&old, &row);
    row = helper_row(1, b, count, &memory);
    bench_add(&new, &row);
    size_t found = bench_compare(&old, &new, 0.03, &memory, &changes);
    assert_int_equal(found, 2);
    assert_string_equal(changes[1].name, "all");
    bench_change c = changes[1];
    bench_results_free(&old);
    bench_results_free(&new);
    arena_free(&memory);
    return c;
}

static void frames_are_compared_one_by_one(void **state) {
    (void)state;
    // Frames differ by far more than both runs do, but each frame is 10 % slower.
    bench_change c = change_of(10, 11, 1, 0, MANY);
    assert_int_equal(c.verdict, BENCH_SLOWER);
    assert_true(c.chance >= 0 && c.chance < 0.01 && fabs(c.ratio - 1.1) < 1e-9);
    assert_int_equal(change_of(11, 10, 1, 0, MANY).verdict, BENCH_FASTER);
    assert_int_equal(change_of(10, 10.2, 1, 0, MANY).verdict, BENCH_SAME);   // within the margin
    assert_int_equal(change_of(10, 10.4, 0.1, 1, MANY).verdict, BENCH_SAME); // to and fro
}

static void few_frames_are_compared_by_their_bands(void **state) {
    (void)state;
    bench_change c = change_of(10, 11, 1, 0, 4);
    assert_int_equal(c.verdict, BENCH_SAME);
    assert_true(c.chance < 0);
    assert_int_equal(change_of(10, 20, 1, 0, 4).verdict, BENCH_SLOWER);
    assert_int_equal(change_of(10, 5, 0.1, 0, 1).verdict, BENCH_FASTER);
}

static void only_rows_that_both_have_are_compared(void **state) {
    (void)state;
    static const double values[] = {1};
    arena memory = {0};
    bench_results old, new;
    bench_change *changes;
    helper_head(&old);
    helper_head(&new);
    bench_row one = helper_row(1, values, 1, &memory), two = helper_row(2, values, 1, &memory);
    bench_row failed = helper_row(3, values, 1, &memory);
    bench_add(&old, &one);
    bench_add(&old, &failed);
    failed.state = BENCH_FAILED;
    two.index = 1; // another row of the same number
    one.index = 2;
    bench_add(&new, &two);
    bench_add(&new, &one);
    bench_add(&new, &failed);
    assert_int_equal(bench_compare(&old, &new, 0.03, &memory, &changes), 2);
    assert_string_equal(changes[0].before->label, changes[0].now->label);
    bench_results_free(&old);
    bench_results_free(&new);
    arena_free(&memory);
}

// ---- choosing -----------------------------------------------------------------------------------

// Two axes of 3 and 2 values.
static sweep make_sweep(arena *memory) {
    static const char *steps[] = {"16", "32", "64"}, *noises[] = {"perlin", "worley"};
    static sweep_axis axes[] = {{"march.steps", "steps", steps, 3}, {"noise", "noise", noises, 2}};
    sweep s = {.name = "s", .file = "s.lua", .axes = axes, .axis_count = 2, .row_count = 6};
    s.rows = arena_alloc(memory, s.row_count * sizeof *s.rows);
    for (size_t i = 0; i < s.row_count; i++) {
        sweep_pair pairs[] = {{"march.steps", steps[i / 2]}, {"noise", noises[i % 2]}};
        s.rows[i].label = arena_format(memory, "steps %s, %s", steps[i / 2], noises[i % 2]);
        s.rows[i].axes = arena_copy(memory, pairs, sizeof pairs);
        s.rows[i].axis_count = 2;
    }
    return s;
}

static void chosen_are(const bench_choice *choice, const char *expected) {
    arena memory = {0};
    sweep s = make_sweep(&memory);
    char found[7] = "";
    bool *chosen = bench_choose(&s, choice);
    if (!chosen) fail_msg("%s", err_get());
    for (size_t i = 0; i < s.row_count; i++) found[i] = chosen[i] ? '1' : '0';
    assert_string_equal(found, expected);
    mem_free(chosen);
    arena_free(&memory);
}

static void refused(const bench_choice *choice, const char *message) {
    arena memory = {0};
    sweep s = make_sweep(&memory);
    assert_null(bench_choose(&s, choice));
    if (!strstr(err_get(), message)) fail_msg("\"%s\" is not in: %s", message, err_get());
    arena_free(&memory);
}

static void rows_are_chosen(void **state) {
    (void)state;
    const roil_setting only[] = {{"steps", "16"}, {"march.steps", "64"}, {"noise", "worley"}};
    chosen_are(&(bench_choice){0}, "111111");
    chosen_are(&(bench_choice){.rows = "steps 32*"}, "001100");
    chosen_are(&(bench_choice){.only = only, .only_count = 2}, "110011");
    chosen_are(&(bench_choice){.only = only, .only_count = 3}, "010001");
    chosen_are(&(bench_choice){.shard = 1, .shards = 2}, "101010");
    chosen_are(&(bench_choice){.shard = 2, .shards = 4}, "010001");
    chosen_are(&(bench_choice){.only = only, .only_count = 2, .shard = 2, .shards = 2}, "010001");
}

static void choices_that_leave_nothing_are_refused(void **state) {
    (void)state;
    const roil_setting axis[] = {{"step", "16"}}, value[] = {{"noise", "curl"}};
    refused(&(bench_choice){.only = axis, .only_count = 1}, "did you mean 'steps'?");
    refused(&(bench_choice){.only = value, .only_count = 1}, "accepted: perlin, worley");
    refused(&(bench_choice){.rows = "none*"}, "no row is like 'none*'");
    refused(&(bench_choice){.shard = 7, .shards = 7}, "no row is left");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_compared_one_by_one),
        cmocka_unit_test(few_frames_are_compared_by_their_bands),
        cmocka_unit_test(only_rows_that_both_have_are_compared),
        cmocka_unit_test(rows_are_chosen),
        cmocka_unit_test(choices_that_leave_nothing_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
