// Runs every tests/lua/*.lua as an effect, and compiles its shaders. A file asserts what it can say
// itself; comments say the rest, one a line:
//   -- expect error: TEXT    loading or compiling fails, and the message contains TEXT
//   -- expect passes: N      the effect has N passes
//   -- expect params: N      and N parameters
//   -- set: NAME=VALUE       as given by --set
#include "script_helper.h"

enum { SETTINGS_MAX = 8 };

typedef struct expectation {
    char error[512];
    int passes, params; // -1: any
    char settings[SETTINGS_MAX][512];
    effect_setting pairs[SETTINGS_MAX];
    size_t setting_count;
} expectation;

static void read_setting(expectation *x, const char *text) {
    assert_true(x->setting_count < SETTINGS_MAX);
    char *own = x->settings[x->setting_count];
    snprintf(own, sizeof x->settings[0], "%s", text);
    char *equals = strchr(own, '=');
    assert_non_null(equals);
    *equals = 0;
    x->pairs[x->setting_count++] = (effect_setting){own, equals + 1, NULL};
}

static void read_line(expectation *x, const char *line) {
    static const char error[] = "-- expect error: ", set[] = "-- set: ";
    if (strncmp(line, error, sizeof error - 1) == 0)
        snprintf(x->error, sizeof x->error, "%s", line + sizeof error - 1);
    else if (strncmp(line, set, sizeof set - 1) == 0)
        read_setting(x, line + sizeof set - 1);
    else if (sscanf(line, "-- expect passes: %d", &x->passes) != 1 &&
             sscanf(line, "-- expect params: %d", &x->params) != 1 &&
             strncmp(line, "-- expect", 9) == 0)
        fail_msg("unknown expectation: %s", line);
}

static void read_expectation(const char *path, expectation *x) {
    *x = (expectation){.passes = -1, .params = -1};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char line[512];
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        read_line(x, line);
    }
    fclose(file);
}

static bool run(const char *path) {
    expectation x;
    read_expectation(path, &x);
    char scripts[PATH_CAP];
    helper_source(scripts, "scripts");
    effect *e = helper_create(path, x.pairs, x.setting_count);
    bool ok = script_load(e, scripts) && effect_check(e);
    const char *fault = NULL;
    if (x.error[0]) {
        if (ok || !strstr(err_get(), x.error)) fault = "another error was expected";
    } else if (!ok) {
        fault = "no error was expected";
    } else if (x.passes >= 0 && (int)effect_pass_count(e) != x.passes) {
        fault = "another number of passes was expected";
    } else if (x.params >= 0 && (int)effect_param_count(e) != x.params) {
        fault = "another number of parameters was expected";
    }
    if (fault) print_error("%s: %s\n%s\n", path_name(path), fault, ok ? "it loads" : err_get());
    effect_destroy(e);
    return !fault;
}

static void every_file_does_what_it_says(void **state) {
    (void)state;
    char pattern[PATH_CAP];
    file_list files;
    helper_source(pattern, "tests/lua/*.lua");
    assert_true(file_glob(pattern, &files));
    assert_true(files.count >= 5);
    bool all = true;
    for (size_t i = 0; i < files.count; i++) all &= run(files.paths[i]);
    file_list_free(&files);
    assert_true(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_file_does_what_it_says)};
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
