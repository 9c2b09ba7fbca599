// Burning gas against theory and published data: one page.
//
//   bench_pyro_theory [-o FOLDER] [-f FINE] [-a upwind|parabolic|reflection] [-V] [-d DEVICE] [-r]
//   [CHECK...]
//
// Writes results.json and report.html to the folder (out/pyro_theory), and prints each figure with
// its bounds. CHECK: those alone, of plume, flames, pool, fireball, vortex, rings, and tests: what
// the tests of the solver print, those that are built. -f: cells along a side by those of the
// coarse size, which takes ten minutes of a processor; 4 is for a graphics card. -V: variable
// density. -r: the page is
// written again, and nothing measured. Needs ROIL_SOURCE_DIR, or to run in the root of the source.
// The exit status is 1 when a bound is missed, 2 when something else is wrong.
#include "base/file.h"
#include "script/report.h"
#include "write.h"
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef struct entry {
    const char *name;
    theory_run *run;
} entry;

static const entry entries[] = {
    {"plume", theory_plume},       {"flames", theory_flames}, {"pool", theory_pool},
    {"fireball", theory_fireball}, {"vortex", theory_vortex}, {"rings", theory_rings},
};

// What the tests of the solver compare with theory.
static const char *const tests[] = {"sim_pyro_gas", "sim_pyro_flow", "sim_pyro_pressure",
                                    "sim_pyro_solids"};

typedef struct options {
    const char *folder, *device, *source;
    char programs[4096]; // folder of the tests
    double fine;
    pyro_advection advection;
    bool variable_density;
    bool again;
    char **names;
    int name_count;
} options;

static bool parse(int argc, char **argv, options *o) {
    *o = (options){.folder = "out/pyro_theory",
                   .source = getenv("ROIL_SOURCE_DIR"),
                   .fine = 1,
                   .advection = PYRO_PARABOLIC};
    for (int c; (c = getopt(argc, argv, "o:f:d:a:rV")) != -1;) {
        if (c == 'o') o->folder = optarg;
        if (c == 'f') o->fine = atof(optarg);
        if (c == 'd') o->device = optarg;
        for (int i = 0; c == 'a' && i < PYRO_ADVECTIONS; i++)
            if (strcmp(optarg, pyro_advection_names[i]) == 0) o->advection = (pyro_advection)i;
        if (c == 'V') o->variable_density = true;
        if (c == 'r') o->again = true;
        if (c == '?') return false;
    }
    const char *slash = strrchr(argv[0], '/');
    snprintf(o->programs, sizeof o->programs, "%.*s", slash ? (int)(slash - argv[0]) : 1,
             slash ? argv[0] : ".");
    if (!o->source) setenv("ROIL_SOURCE_DIR", o->source = ".", 1);
    o->names = argv + optind;
    o->name_count = argc - optind;
    return o->fine > 0;
}

static bool is_wanted(const options *o, const char *name) {
    for (int i = 0; i < o->name_count; i++)
        if (strcmp(o->names[i], name) == 0) return true;
    return o->name_count == 0;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static json_t *load(const options *o) {
    char path[4200];
    json_error_t error;
    snprintf(path, sizeof path, "%s/results.json", o->folder);
    json_t *results = json_load_file(path, 0, &error);
    if (!results) fprintf(stderr, "%s:%d: %s\n", path, error.line, error.text);
    return results;
}

// The page and the file are written after each check, so that an interrupted run leaves something.
static bool save(const options *o, const json_t *results) {
    char path[4200], scripts[4200];
    strbuf page = {0};
    snprintf(path, sizeof path, "%s/results.json", o->folder);
    snprintf(scripts, sizeof scripts, "%s/scripts/report", o->source);
    bool done = json_dump_file(results, path, JSON_INDENT(1) | JSON_REAL_PRECISION(7)) == 0;
    if (!done) fprintf(stderr, "%s cannot be written\n", path);
    snprintf(path, sizeof path, "%s/report.html", o->folder);
    done = done && script_report(scripts, results, &page);
    FILE *file = done ? fopen(path, "w") : NULL;
    done = file && fwrite(page.text, 1, page.length, file) == page.length;
    if (file) done = fclose(file) == 0 && done;
    if (!done) fprintf(stderr, "%s: %s\n", path, err_get());
    strbuf_free(&page);
    return done;
}

static json_t *begin(const options *o, gpu *g) {
    char date[32];
    const time_t t = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%d %H:%M", gmtime(&t));
    return json_pack("{s:s, s:s, s:s, s:f, s:[], s:[]}", "device", gpu_get_info(g)->name, "driver",
                     gpu_get_info(g)->driver, "date", date, "fine", o->fine, "checks", "tests");
}

// Returns how many bounds are missed; -1: nothing could be written.
static int run_all(const options *o, gpu *g) {
    char shaders[4200];
    json_t *results = begin(o, g);
    int missed = 0;
    snprintf(shaders, sizeof shaders, "%s/tests/bench/pyro_theory", o->source);
    const theory_order order = {g, shaders, o->fine, o->advection, o->variable_density};
    for (size_t i = 0; i < COUNT_OF(entries); i++) {
        if (!is_wanted(o, entries[i].name)) continue;
        theory_check c = {0};
        const double start = now();
        entries[i].run(&order, &c);
        write_text(&c, now() - start);
        for (size_t k = 0; k < c.figure_count; k++) missed += !theory_holds(&c.figures[k]);
        json_array_append_new(json_object_get(results, "checks"), write_check(&c, now() - start));
        arena_free(&c.memory);
        if (!save(o, results)) return -1;
    }
    for (size_t i = 0; i < COUNT_OF(tests) && is_wanted(o, "tests"); i++) {
        json_t *test = write_test(o->programs, tests[i]);
        if (!test) continue;
        missed += !json_is_true(json_object_get(test, "passed"));
        json_array_append_new(json_object_get(results, "tests"), test);
    }
    const bool done = save(o, results);
    json_decref(results);
    return done ? missed : -1;
}

int main(int argc, char **argv) {
    options o;
    if (!parse(argc, argv, &o)) return 2;
    if (!file_make_folders(o.folder)) {
        fprintf(stderr, "%s: %s\n", o.folder, err_get());
        return 2;
    }
    if (o.again) {
        json_t *results = load(&o);
        const bool done = results && save(&o, results);
        json_decref(results);
        return done ? 0 : 2;
    }
    gpu *g = gpu_create(&(gpu_desc){.device = o.device});
    if (!g) {
        fprintf(stderr, "device: %s\n", err_get());
        return 2;
    }
    const int missed = run_all(&o, g);
    gpu_destroy(g);
    if (missed >= 0) printf("wrote %s/results.json, report.html; %d missed\n", o.folder, missed);
    return missed < 0 ? 2 : missed > 0;
}
