// Measures how soon an edit is visible: from the close of the file to the submission of the first
// frame that shows it. Drawing is not included: the device is idle when the file is written, and is
// not waited for afterwards. A copy of the effect's folder is edited.
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "bench/run_parts.h"
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { SCRIPT_MAX = 16 << 20 };
static const double PATIENCE = 30; // seconds that a build may take

typedef struct bell { // rung by the builder
    pthread_mutex_t mutex;
    pthread_cond_t rung;
    bool ringing;
} bell;

static void ring(void *user) {
    bell *b = user;
    pthread_mutex_lock(&b->mutex);
    b->ringing = true;
    pthread_cond_signal(&b->rung);
    pthread_mutex_unlock(&b->mutex);
}

static bool wait_for_ring(bell *b) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += (time_t)PATIENCE;
    int status = 0;
    pthread_mutex_lock(&b->mutex);
    while (!b->ringing && status == 0) status = pthread_cond_timedwait(&b->rung, &b->mutex, &until);
    b->ringing = false;
    pthread_mutex_unlock(&b->mutex);
    return status == 0 || err_set("an edit was not built within %g s", PATIENCE);
}

typedef struct reload {
    bench_session *session;
    const bench_job *job;
    const bench_row *row;
    roil_live *live;
    bell news;
    double frame;
    char path[PATH_CAP]; // of the copy
    char *script;        // as it was
    uint8_t *pixels;
    bench_collection times;
} reload;

// Takes over what the builder has finished. `changed`: whether that was anything.
static bool take(reload *m, bool *changed) {
    *changed = roil_live_update(m->live, m->row->width, m->row->height, m->frame);
    const char *message = roil_live_message(m->live);
    return !message || err_set("%s", message);
}

static bool draw(reload *m) {
    roil_effect *e = roil_live_effect(m->live);
    roil_on_progress(e, bench_go_on, m->session);
    return roil_advance(e, m->frame++);
}

// A file that was written a moment before it was read is built twice: what is left of an edit must
// not be taken for the next one. Nothing is being drawn or built then.
static bool calm_down(reload *m) {
    bool changed = true;
    roil_live_wait(m->live);
    while (changed)
        if (!take(m, &changed)) return false;
    pthread_mutex_lock(&m->news.mutex);
    m->news.ringing = false;
    pthread_mutex_unlock(&m->news.mutex);
    return roil_read(roil_live_effect(m->live), false, m->pixels);
}

// Writes in place, as most editors do.
static bool write_script(const reload *m, const char *text) {
    FILE *file = fopen(m->path, "we");
    if (!file) return err_set("%s: %s", m->path, strerror(errno));
    bool done = fputs(text, file) >= 0;
    done = fclose(file) == 0 && done;
    return done || err_set("%s: cannot be written", m->path);
}

static bool time_edit(reload *m, const char *text, bool counts) {
    bool changed;
    if (!calm_down(m) || !write_script(m, text)) return false;
    double closed = clock_seconds();
    if (!wait_for_ring(&m->news)) return false;
    double woken = clock_seconds();
    if (!take(m, &changed)) return false;
    double taken = clock_seconds();
    if (!changed) return err_set("an edit changed nothing");
    if (!draw(m)) return false;
    double submitted = clock_seconds();
    if (!counts) return true;
    bench_collect(&m->times, "reload", 1e3 * (submitted - closed));
    bench_collect(&m->times, "take_over", 1e3 * (taken - woken));
    return true;
}

// The script with the text that is edited replaced by number `number` of what comes in its place.
static bool edit(reload *m, size_t number, bool counts) {
    const bench_job *job = m->job;
    const char *find = job->edits[0];
    const char *put = job->edits[1 + number % (job->edit_count - 1)];
    const char *at = strstr(m->script, find);
    if (!at) return err_set("%s: has no text '%.64s' to edit", m->row->effect, find);
    strbuf text = {0};
    strbuf_append(&text, m->script, (size_t)(at - m->script));
    strbuf_add(&text, "%s%s", put, at + strlen(find));
    bool done = time_edit(m, text.text, counts);
    strbuf_free(&text);
    return done;
}

static bool start(reload *m) {
    const bench_row *row = m->row;
    void *data;
    size_t size;
    if (!file_read_inside(row->inside, row->effect, SCRIPT_MAX, &data, &size)) return false;
    m->script = data;
    // The copy may be a link, through which an edit would reach what it leads to.
    if ((unlink(m->path) != 0 && errno != ENOENT) || !file_write(m->path, data, size))
        return err_set("%s: cannot be written", m->path);
    m->pixels = mem_alloc((size_t)row->width * row->height * 4);
    m->frame = row->frame_count ? row->frames[0] : 1;
    m->live =
        roil_live_create(m->session->r, &(roil_live_desc){.file = m->path,
                                                          .settings = row->settings.items,
                                                          .setting_count = row->settings.count,
                                                          .wake = ring,
                                                          .user = &m->news});
    bool changed;
    return m->live && wait_for_ring(&m->news) && take(m, &changed) && changed && draw(m);
}

static bool reload_run(reload *m) {
    if (!start(m)) return false;
    size_t count = m->row->warmup + m->row->repeats;
    double begin = clock_seconds();
    for (size_t i = 0; i < count; i++) {
        if (bench_is_stopped(m->session)) return false;
        if (m->row->limit > 0 && clock_seconds() - begin > m->row->limit)
            return err_set("took longer than %g s", m->row->limit);
        if (!edit(m, i, i >= m->row->warmup)) return false;
    }
    return true;
}

bool bench_measure_reload(bench_session *s, const bench_job *job, bench_row *row, arena *memory) {
    reload m = {.session = s, .job = job, .row = row};
    char folder[PATH_CAP];
    if (job->edit_count < 2) return err_set("nothing says what is edited");
    if (!bench_folder_make(folder)) return false;
    pthread_mutex_init(&m.news.mutex, NULL);
    pthread_cond_init(&m.news.rung, NULL);
    bool done = bench_folder_copy(row->inside, row->effect, folder) &&
                path_join(m.path, folder, path_name(row->effect)) && reload_run(&m);
    row->times = bench_summarise(&m.times, memory);
    roil_live_destroy(m.live);
    pthread_cond_destroy(&m.news.rung);
    pthread_mutex_destroy(&m.news.mutex);
    bench_collection_free(&m.times);
    mem_free(m.script);
    mem_free(m.pixels);
    bench_folder_remove(folder);
    return done;
}
