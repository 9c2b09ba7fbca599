// Measures how soon a new process of this program is done: `roil check` of an effect, or its first
// frame. Caches of roil and of the driver are in a folder of their own, which is filled by a first
// run that does not count, or emptied before each run.
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/run_parts.h"
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

static const char program[] = "/proc/self/exe";

// Variables that set the cache folders of roil, Mesa and NVIDIA's driver.
static const char *const cache_variables[] = {
    "ROIL_CACHE_DIR", "XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH"};

typedef struct starter {
    bench_session *session;
    const bench_job *job;
    const bench_row *row;
    arena *memory;
    char folder[PATH_CAP], cache[PATH_CAP], log[PATH_CAP];
    const char **arguments;
    char *kept[COUNT_OF(cache_variables)]; // variables as they were; NULL: not set
} starter;

static bool build_arguments(starter *m) {
    const bench_row *row = m->row;
    const char **a = arena_alloc(m->memory, (row->settings.count * 2 + 16) * sizeof *a);
    size_t n = 0;
    m->arguments = a;
    a[n++] = program;
    a[n++] = m->job->command;
    // A name that begins with '-' is no option.
    a[n++] = row->effect[0] == '-' ? arena_format(m->memory, "./%s", row->effect) : row->effect;
    if (strcmp(m->job->command, "render") != 0)
        return row->settings.count == 0 || err_set("roil %s takes no settings", m->job->command);
    a[n++] = "--frames";
    a[n++] = arena_format(m->memory, "%g", row->frame_count ? row->frames[0] : 1.0);
    a[n++] = "--size";
    a[n++] = arena_format(m->memory, "%ux%u", row->width, row->height);
    a[n++] = "-o";
    a[n++] = arena_format(m->memory, "%s/picture.png", m->folder);
    if (m->session->desc.device) {
        a[n++] = "--device";
        a[n++] = m->session->desc.device;
    }
    for (size_t i = 0; i < row->settings.count; i++) {
        a[n++] = "--set";
        a[n++] = arena_format(m->memory, "%s=%s", row->settings.items[i].name,
                              row->settings.items[i].value);
    }
    return true;
}

// Child processes inherit the environment.
static void enter_cache(starter *m) {
    for (size_t i = 0; i < COUNT_OF(cache_variables); i++) {
        const char *value = getenv(cache_variables[i]);
        m->kept[i] = value ? mem_copy(value, strlen(value) + 1) : NULL;
        setenv(cache_variables[i], m->cache, 1);
    }
}

static void leave_cache(starter *m) {
    for (size_t i = 0; i < COUNT_OF(cache_variables); i++) {
        if (m->kept[i])
            setenv(cache_variables[i], m->kept[i], 1);
        else
            unsetenv(cache_variables[i]);
        mem_free(m->kept[i]);
    }
}

static bool failed(const starter *m) { // what the program said
    void *data;
    size_t size;
    if (!file_read(m->log, 1 << 20, &data, &size)) return err_set("the program failed");
    char *text = data;
    text[strcspn(text, "\n")] = '\0';
    err_set("roil %s failed: %.512s", m->job->command, text);
    mem_free(data);
    return false;
}

static bool run_once(starter *m, double *milliseconds) {
    int status;
    if (m->job->empty_cache) bench_folder_remove(m->cache);
    if (!file_make_folders(m->cache)) return false;
    // The process will take it for named by its user.
    if (m->row->inside && !path_require_inside(m->row->inside, m->row->effect)) return false;
    double begin = clock_seconds();
    if (!bench_spawn(m->arguments, m->log, &status)) return false;
    *milliseconds = 1e3 * (clock_seconds() - begin);
    return status == 0 || failed(m);
}

static bool run_all(starter *m, bench_collection *times) {
    uint32_t warmup = m->row->warmup;
    if (!m->job->empty_cache && warmup == 0) warmup = 1; // what warms the cache does not count
    double milliseconds, begin = clock_seconds();
    for (uint32_t i = 0; i < warmup + m->row->repeats; i++) {
        if (bench_is_stopped(m->session)) return false;
        if (m->row->limit > 0 && clock_seconds() - begin > m->row->limit)
            return err_set("took longer than %g s", m->row->limit);
        if (!run_once(m, &milliseconds)) return false;
        if (i >= warmup) bench_collect(times, "start", milliseconds);
    }
    return true;
}

bool bench_measure_start(bench_session *s, const bench_job *job, bench_row *row, arena *memory) {
    starter m = {.session = s, .job = job, .row = row, .memory = memory};
    bench_collection times = {0};
    if (!bench_folder_make(m.folder)) return false;
    bool done = build_arguments(&m) && path_join(m.cache, m.folder, "cache") &&
                path_join(m.log, m.folder, "log");
    enter_cache(&m);
    done = done && run_all(&m, &times);
    leave_cache(&m);
    row->times = bench_summarise(&times, memory);
    bench_collection_free(&times);
    bench_folder_remove(m.folder);
    return done;
}
