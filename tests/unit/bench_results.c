// Results as files: what is written is read, parts become one, and what is no result is refused.
#include "bench_helper.h"

static bench_row full_row(arena *memory) {
    static const double values[] = {1.5, 2.5, 2};
    bench_row row = helper_row(1, values, 3, memory);
    row.label = "steps 16, \"quoted\"";
    row.limit = 60;
    row.settings.items = arena_alloc(memory, sizeof *row.settings.items);
    row.settings.items[row.settings.count++] = (roil_setting){"camera.eye", "1,2,3"};
    row.cpu.items = arena_alloc(memory, sizeof *row.cpu.items);
    row.cpu.items[row.cpu.count++] = (bench_time){"frame", {3, 2, 4, 3, NULL}};
    row.times.items = arena_alloc(memory, sizeof *row.times.items);
    row.times.items[row.times.count++] = (bench_time){"reload", {30, 20, 40, 9, NULL}};
    row.counters.items = arena_alloc(memory, sizeof *row.counters.items);
    row.counters.items[row.counters.count++] = (sweep_number){"march.samples", 123456789};
    row.published.items = arena_alloc(memory, sizeof *row.published.items);
    row.published.items[row.published.count++] = (sweep_number){"a card", 7.21};
    row.device_bytes = 1 << 20;
    row.reserved_bytes = 2 << 20;
    row.host_bytes = 3 << 20;
    row.compared = true;
    row.psnr = INFINITY;
    row.ssim = 1;
    row.thumbnail = "rows/0001.png";
    return row;
}

static void fill(bench_results *r) {
    static const double values[] = {4};
    arena memory = {0};
    helper_head(r);
    r->has_reference = true;
    r->reference = (bench_reference){.traced = true, .samples = 64};
    bench_row row = full_row(&memory), failed = helper_row(0, values, 1, &memory);
    failed.state = BENCH_FAILED;
    failed.message = "a.lua:3: bad, \"very\" bad\nand more";
    bench_add(r, &row);
    bench_add(r, &failed); // sorted in
    arena_free(&memory);
}

static void what_is_written_is_read(void **state) {
    (void)state;
    bench_results r, back;
    fill(&r);
    assert_true(bench_write(&r, helper_folder));
    if (!bench_read(helper_folder, &back)) fail_msg("%s", err_get());
    assert_string_equal(back.title, "A sweep");
    assert_string_equal(back.commit, "abc1234");
    assert_string_equal(back.content, "c0ffee");
    assert_string_equal(back.os, "a system");
    assert_int_equal(back.cores, 2);
    assert_int_equal(back.note_count, 2);
    assert_string_equal(back.axes[0].values[2], "32");
    assert_true(back.has_reference && back.reference.traced && back.reference.samples == 64);
    assert_int_equal(back.row_count, 2);
    const bench_row *failed = &back.rows[0], *row = &back.rows[1];
    assert_int_equal(failed->state, BENCH_FAILED);
    assert_string_equal(failed->message, "a.lua:3: bad, \"very\" bad\nand more");
    assert_int_equal(row->index, 1);
    assert_string_equal(row->label, "steps 16, \"quoted\"");
    assert_string_equal(bench_axis_value(row, "steps"), "16");
    assert_null(bench_axis_value(row, "none"));
    assert_string_equal(row->settings.items[0].value, "1,2,3");
    assert_true(row->limit == 60 && row->frame_count == 3 && row->frames[2] == 2);
    const bench_figure *march = bench_get_time(&row->gpu, "march");
    assert_true(march->median == 2 && march->p5 == 1.5 && march->p95 == 2.5 && march->count == 3);
    assert_true(march->values[1] == 2.5);
    assert_string_equal(bench_main_time(row)->name, "all");
    assert_null(bench_get_time(&row->cpu, "frame")->values);
    assert_true(bench_get_time(&row->times, "reload")->p95 == 40);
    assert_true(row->counters.items[0].value == 123456789 && row->published.items[0].value == 7.21);
    assert_true(row->device_bytes == 1 << 20 && row->host_bytes == 3 << 20);
    assert_true(row->compared && isinf(row->psnr) && row->ssim == 1 && row->flip == 0);
    assert_string_equal(row->thumbnail, "rows/0001.png");
    bench_results_free(&r);
    bench_results_free(&back);
}

static void a_table_has_a_column_for_whatever_a_row_has(void **state) {
    (void)state;
    bench_results r;
    char path[PATH_CAP];
    void *data;
    size_t size, columns[3] = {0};
    fill(&r);
    assert_true(bench_write(&r, helper_folder));
    helper_path(path, "results.csv");
    assert_true(file_read(path, 1 << 20, &data, &size));
    const char *text = data;
    assert_non_null(strstr(text, ",axis.steps,"));
    assert_non_null(strstr(text, ",gpu.march.p95,"));
    assert_non_null(strstr(text, ",published.a card,device\n"));
    assert_non_null(strstr(text, "\"steps 16, \"\"quoted\"\"\""));
    int line = 0;
    bool quoted = false;
    for (; *text && line < 3; text++) {
        if (*text == '"') quoted = !quoted;
        columns[line] += *text == ',' && !quoted;
        line += *text == '\n' && !quoted;
    }
    assert_int_equal(line, 3);
    assert_int_equal(columns[0], columns[1]);
    assert_int_equal(columns[0], columns[2]);
    mem_free(data);
    bench_results_free(&r);
}

static void a_row_that_is_measured_again_is_replaced(void **state) {
    (void)state;
    static const double one[] = {1}, two[] = {2};
    arena memory = {0};
    bench_results r;
    helper_head(&r);
    bench_row row = helper_row(3, one, 1, &memory);
    bench_add(&r, &row);
    row = helper_row(3, two, 1, &memory);
    bench_add(&r, &row);
    assert_int_equal(r.row_count, 1);
    assert_true(bench_main_time(bench_find(&r, 3))->ms.median == 2);
    assert_null(bench_find(&r, 2));
    arena_free(&memory);
    bench_results_free(&r);
}

// ---- parts --------------------------------------------------------------------------------------

static void write_part(const char *name, size_t index, const char *content, const char *device) {
    static const double values[] = {1, 2};
    char path[PATH_CAP];
    arena memory = {0};
    bench_results r;
    helper_head(&r);
    r.content = content;
    r.device = device;
    bench_row row = helper_row(index, values, 2, &memory);
    row.thumbnail = arena_format(&memory, "rows/%04zu.png", index);
    bench_add(&r, &row);
    helper_path(path, name);
    assert_true(bench_write(&r, path));
    char picture[64];
    snprintf(picture, sizeof picture, "%s/rows/%04zu.png", name, index);
    helper_put(picture, "picture", 7);
    arena_free(&memory);
    bench_results_free(&r);
}

static bool merge(const char *one, const char *other) {
    char a[PATH_CAP], b[PATH_CAP], to[PATH_CAP];
    const char *folders[] = {a, b};
    bench_results r;
    helper_path(a, one);
    helper_path(b, other);
    helper_path(to, "merged");
    bool done = bench_merge(folders, 2, to, &r);
    bench_results_free(&r);
    return done;
}

static void parts_become_one(void **state) {
    (void)state;
    char path[PATH_CAP];
    bench_results r;
    write_part("b", 1, "same", "d");
    write_part("a", 2, "same", "d");
    if (!merge("a", "b")) fail_msg("%s", err_get());
    helper_path(path, "merged");
    assert_true(bench_read(path, &r));
    assert_int_equal(r.row_count, 2);
    assert_int_equal(r.rows[0].index, 1);
    assert_int_equal(r.rows[1].index, 2);
    bench_results_free(&r);
    helper_path(path, "merged/rows/0001.png");
    assert_true(file_exists(path));
    helper_path(path, "merged/rows/0002.png");
    assert_true(file_exists(path));
}

static void parts_of_another_device_are_marked(void **state) {
    (void)state;
    char path[PATH_CAP];
    bench_results r;
    write_part("a", 1, "same", "d");
    write_part("c", 2, "same", "e");
    if (!merge("a", "c")) fail_msg("%s", err_get());
    helper_path(path, "merged");
    assert_true(bench_read(path, &r));
    assert_string_equal(r.device, "d");
    assert_true(!r.rows[0].device || !r.rows[0].device[0]);
    assert_int_equal(strncmp(r.rows[1].device, "e (", 3), 0);
    bench_results_free(&r);
    write_part("b", 3, "same", "d"); // the mark stays in what is merged again
    if (!merge("b", "merged")) fail_msg("%s", err_get());
    assert_true(bench_read(path, &r));
    assert_int_equal(r.row_count, 3);
    assert_int_equal(strncmp(r.rows[1].device, "e (", 3), 0);
    assert_true(!r.rows[2].device || !r.rows[2].device[0]);
    bench_results_free(&r);
}

static void parts_of_something_else_are_refused(void **state) {
    (void)state;
    write_part("a", 1, "same", "d");
    write_part("b", 2, "other", "d");
    write_part("d", 1, "same", "d");
    assert_false(merge("a", "b"));
    assert_non_null(strstr(err_get(), "is of another sweep"));
    assert_false(merge("a", "d"));
    assert_non_null(strstr(err_get(), "measured by another part, too"));
    assert_false(merge("a", "none"));
    assert_non_null(strstr(err_get(), "none/results.json: No such file"));
}

// ---- files of strangers -------------------------------------------------------------------------

static void what_is_no_result_is_refused(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"", "is no JSON"},
        {"{", "is no JSON"},
        {"[]", "an object"},
        {"{}", "rows must be a list"},
        {"{\"rows\": 3}", "rows must be a list"},
        {"{\"rows\": [3]}", "rows[0] must be an object"},
        {"{\"rows\": [{\"state\": \"planned\"}]}", "rows[0].state must be"},
        {"{\"rows\": [{\"state\": \"done\", \"index\": -1}]}", "rows[0].index must be"},
        {"{\"rows\": [{\"state\": \"done\", \"index\": 4096}]}", "rows[0].index must be"},
        {"{\"rows\": [{\"state\": \"done\"}, {\"state\": \"done\"}]}",
         "above that of the row before"},
        {"{\"rows\": [{\"state\": \"done\", \"label\": 3}]}", "rows[0].label must be a text"},
        {"{\"rows\": [{\"state\": \"done\", \"axes\": {\"a\": 3}}]}", "an object of texts"},
        {"{\"rows\": [{\"state\": \"done\", \"gpu_ms\": {\"a\": 3}}]}", "an object of figures"},
        {"{\"rows\": [{\"state\": \"done\", \"gpu_ms\": {\"a\": {\"median\": \"x\"}}}]}",
         "median must be a number"},
        {"{\"rows\": [{\"state\": \"done\", \"gpu_ms\": {\"a\": {\"count\": 2, \"values\": "
         "[1]}}}]}",
         "as many as 'count' says"},
        {"{\"rows\": [{\"state\": \"done\", \"limit\": 1e300}]}", "up to 1e15"},
        {"{\"rows\": [{\"state\": \"done\", \"thumbnail\": \"../../secret.png\"}]}",
         "as \"rows/0000.png\""},
        {"{\"rows\": [{\"state\": \"done\", \"error\": 3}]}", "error must be an object"},
        {"{\"rows\": [], \"title\": 3}", "title must be a text"},
        {"{\"rows\": [], \"rows\": []}", "is no JSON"},
        {"{\"rows\": [], \"axes\": [{\"values\": [3]}]}", "axes[0].values must be a list of texts"},
        {"{\"rows\": [], \"reference\": {\"kind\": \"x\"}}", "reference.kind must be"},
        {"{\"rows\": [], \"machine\": {\"cores\": -1}}", "cores must be"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        bench_results r;
        helper_put("results.json", cases[i][0], strlen(cases[i][0]));
        if (bench_read(helper_folder, &r)) fail_msg("%s was taken", cases[i][0]);
        if (!strstr(err_get(), cases[i][1]))
            fail_msg("%s: \"%s\" is not in: %s", cases[i][0], cases[i][1], err_get());
        assert_int_equal(r.row_count, 0);
    }
}

static void texts_lose_control_characters(void **state) {
    (void)state;
    static const char text[] = "{\"title\": \"a\\u001b[2Jb\", \"rows\": []}";
    bench_results r;
    helper_put("results.json", text, strlen(text));
    assert_true(bench_read(helper_folder, &r));
    assert_string_equal(r.title, "a?[2Jb");
    bench_results_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(a_table_has_a_column_for_whatever_a_row_has),
        cmocka_unit_test(a_row_that_is_measured_again_is_replaced),
        cmocka_unit_test(parts_become_one),
        cmocka_unit_test(parts_of_another_device_are_marked),
        cmocka_unit_test(parts_of_something_else_are_refused),
        cmocka_unit_test(what_is_no_result_is_refused),
        cmocka_unit_test(texts_lose_control_characters),
    };
    return cmocka_run_group_tests(tests, helper_make, helper_remove);
}
