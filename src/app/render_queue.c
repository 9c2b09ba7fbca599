#include "app/render_queue.h"
#include "app/arguments.h"
#include "app/label.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST = 32, NICE = 10 };
static const float WIDTH = 420, HEIGHT = 360; // units

typedef enum job_state { JOB_WAITS, JOB_RUNS, JOB_DONE, JOB_FAILED, JOB_STOPPED } job_state;

typedef struct render_job {
    arguments what;
    char name[128]; // of its files
    job_state state;
    pid_t process;
    int pipe;        // what it says
    char line[1024]; // the last that it said, or has begun to
    size_t length;
    char said[256]; // "12 of 90 frames, 0.50 s each, 0:39 left", or why it failed
    double part;    // 0 to 1
} render_job;

enum { RENDER_SHEET = 7, RENDER_FORMATS };
static const char *const format_words[RENDER_FORMATS] = {
    "PNG pictures",        "EXR pictures", "MP4 video", "WebM video",
    "ProRes video (.mov)", "GIF",          "APNG",      [RENDER_SHEET] = "sheet of a flipbook"};
static const char *const format_ends[RENDER_FORMATS] = {
    "-%04d.png", "-%04d.exr", ".mp4", ".webm", ".mov", ".gif", ".apng", [RENDER_SHEET] = ".png"};

struct render_queue {
    bool open;
    render_job jobs[MOST];
    size_t count;
    char frames[64], size[32], samples[16], output[256];
    char chosen[64], cells[32], cell[16], maps[96]; // of a sheet; the first: frames
    size_t format;
    bool filled; // the fields have a first text
};

render_queue *render_queue_create(void) {
    return mem_alloc(sizeof(render_queue));
}

static void job_end(render_job *j, bool stop) {
    int status = 0;
    if (stop) kill(j->process, SIGTERM);
    while (waitpid(j->process, &status, 0) < 0 && errno == EINTR) continue;
    close(j->pipe);
    bool done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    j->state = stop ? JOB_STOPPED : done ? JOB_DONE : JOB_FAILED;
    if (done) j->part = 1;
    const char *how = stop ? "stopped" : done ? "done" : "failed: ";
    log_write(LOG_DEBUG, "live: rendering of %s %s%s", j->name, how, stop || done ? "" : j->said);
}

void render_queue_destroy(render_queue *q) {
    for (size_t i = 0; i < q->count; i++) {
        if (q->jobs[i].state == JOB_RUNS) job_end(&q->jobs[i], true);
        arguments_free(&q->jobs[i].what);
    }
    mem_free(q);
}

// ---- running ----------------------------------------------------------------------------------

static bool job_spawn(render_job *j, int output) {
    extern char **environ;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    int error = posix_spawn(&j->process, "/proc/self/exe", &actions, NULL, j->what.list, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error) snprintf(j->said, sizeof j->said, "it cannot be started: %s", strerror(error));
    return !error;
}

// The window comes first, so it is as nice as can be.
static void job_start(render_job *j) {
    int ends[2];
    j->state = JOB_FAILED;
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        snprintf(j->said, sizeof j->said, "it cannot be started: %s", strerror(errno));
        return;
    }
    fcntl(ends[1], F_SETFL, 0); // only the reading end does not wait
    if (job_spawn(j, ends[1])) {
        j->state = JOB_RUNS;
        j->pipe = ends[0];
        setpriority(PRIO_PROCESS, (id_t)j->process, NICE);
        log_write(LOG_DEBUG, "live: rendering of %s begins", j->name);
    } else {
        close(ends[0]);
    }
    close(ends[1]);
}

// A line of progress, or, if it turns out to be the last, a reason.
static void take_line(render_job *j) {
    double done, whole;
    char unit[16];
    if (!j->line[0] || strncmp(j->line, "debug:", 6) == 0) return;
    str_copy(j->said, sizeof j->said, j->line);
    if (sscanf(j->line, "%lf of %lf %15[a-z]", &done, &whole, unit) == 3 && whole > 0 &&
        strcmp(unit, "files") != 0 && strcmp(unit, "steps") != 0)
        j->part = done / whole;
}

static void take_text(render_job *j, const char *text, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (text[i] != '\n' && text[i] != '\r') {
            if (j->length + 1 < sizeof j->line) j->line[j->length++] = text[i];
            continue;
        }
        j->line[j->length] = '\0';
        take_line(j);
        j->length = 0;
    }
}

static void job_read(render_job *j) {
    char text[4096];
    ssize_t count;
    while ((count = read(j->pipe, text, sizeof text)) > 0) take_text(j, text, (size_t)count);
    if (count == 0) job_end(j, false);
}

bool render_queue_runs(const live *l) {
    const render_queue *q = l->queue;
    for (size_t i = 0; i < q->count; i++)
        if (q->jobs[i].state <= JOB_RUNS) return true;
    return false;
}

void render_queue_update(live *l) {
    render_queue *q = l->queue;
    for (size_t i = 0; i < q->count; i++) {
        if (q->jobs[i].state == JOB_RUNS) job_read(&q->jobs[i]);
        if (q->jobs[i].state == JOB_RUNS) return;
    }
    for (size_t i = 0; i < q->count; i++) {
        if (q->jobs[i].state != JOB_WAITS) continue;
        job_start(&q->jobs[i]);
        return;
    }
}

// ---- asking -----------------------------------------------------------------------------------

static void fill(live *l, render_queue *q) {
    int length;
    const char *name = path_stem(l->file, &length);
    snprintf(q->frames, sizeof q->frames, "%.0f-%.0f", l->time.from, l->time.to);
    if (q->filled) return;
    str_copy(q->size, sizeof q->size, "1920x1080");
    str_copy(q->cells, sizeof q->cells, "8x8");
    str_copy(q->cell, sizeof q->cell, "256");
    str_copy(q->maps, sizeof q->maps, "color");
    snprintf(q->output, sizeof q->output, "out/%.*s", length, name);
    q->filled = true;
}

void render_queue_open(live *l) {
    if (!l->effect) return;
    l->queue->open = !l->queue->open;
    if (l->queue->open) fill(l, l->queue);
}

bool render_queue_close(live *l) {
    bool was = l->queue->open;
    l->queue->open = false;
    return was;
}

static const char *name_output(const render_queue *q, char *out, size_t capacity) {
    snprintf(out, capacity, "%s%s", q->output, format_ends[q->format]);
    return out;
}

static void add_all(arguments *a, const char *const *list, size_t count) {
    for (size_t i = 0; i < count; i++) arguments_add(a, list[i]);
}

static void add_wishes(arguments *a, const render_queue *q) {
    const char *const sheet[] = {"roil",   "export", "sheet",  "--grid", q->cells,
                                 "--cell", q->cell,  "--maps", q->maps};
    const char *const pictures[] = {"roil", "render", "--size", q->size, "--frames", q->frames};
    const char *const chosen[] = {"--frames", q->chosen}, *const traced[] = {"--reference",
                                                                             q->samples};
    if (q->format == RENDER_SHEET) {
        add_all(a, sheet, COUNT_OF(sheet));
        if (q->chosen[0]) add_all(a, chosen, COUNT_OF(chosen));
    } else {
        add_all(a, pictures, COUNT_OF(pictures));
        if (q->samples[0]) add_all(a, traced, COUNT_OF(traced));
    }
}

// What is set in the window holds for it, and the file is the one that is there when its turn
// comes.
static void ask(live *l, render_queue *q) {
    char output[320];
    if (q->count == MOST) {
        live_notice(l, "The queue is full: remove what is done");
        return;
    }
    render_job *j = &q->jobs[q->count++];
    *j = (render_job){.state = JOB_WAITS};
    name_output(q, output, sizeof output);
    str_copy(j->name, sizeof j->name, output);
    const char *const to[] = {"--output", output};
    add_wishes(&j->what, q);
    add_all(&j->what, to, COUNT_OF(to));
    arguments_add_device(&j->what, l->device);
    arguments_add_moved(&j->what, l->effect);
    arguments_add(&j->what, "--");
    arguments_add(&j->what, l->file);
    log_write(LOG_DEBUG, "live: asked for %s", output);
}

static void forget(render_queue *q, size_t index) {
    arguments_free(&q->jobs[index].what);
    memmove(&q->jobs[index], &q->jobs[index + 1], (q->count - index - 1) * sizeof *q->jobs);
    q->count--;
}

// ---- the window -------------------------------------------------------------------------------

static void draw_picture_fields(render_queue *q) {
    ui_width(0);
    ui_input("frames", "30 or 1-100 or 10,30", q->frames, sizeof q->frames);
    ui_width(0);
    ui_input("size", "1920x1080", q->size, sizeof q->size);
    ui_width(0);
    ui_input("samples", "none: as the window shows it", q->samples, sizeof q->samples);
    ui_tooltip("traces so many paths of light a pixel instead, without approximations");
}

static void draw_sheet_fields(render_queue *q) {
    ui_width(0);
    ui_input("frames", "all, evenly spread over the cells", q->chosen, sizeof q->chosen);
    ui_width(0);
    ui_input("cells", "8x8", q->cells, sizeof q->cells);
    ui_tooltip("across and down");
    ui_width(0);
    ui_input("cell size", "256", q->cell, sizeof q->cell);
    ui_tooltip("pixels along each side of a cell");
    ui_width(0);
    ui_input("maps", "color,motion,six-way", q->maps, sizeof q->maps);
    ui_tooltip("color, motion, six-way, normal, depth, temperature, separated by commas");
}

static void draw_fields(render_queue *q) {
    ui_push("render");
    ui_width(0);
    ui_choice("format", &q->format, format_words, RENDER_FORMATS);
    if (q->format == RENDER_SHEET)
        draw_sheet_fields(q);
    else
        draw_picture_fields(q);
    ui_width(0);
    ui_input("files", "out/name", q->output, sizeof q->output);
    ui_pop();
}

static void draw_job(render_queue *q, size_t index) {
    static const char *const words[] = {"waits", "runs", "done", "failed", "stopped"};
    render_job *j = &q->jobs[index];
    float s = ui_scale();
    char id[32];
    snprintf(id, sizeof id, "job %zu", index);
    ui_push(id);
    ui_canvas c = ui_canvas_begin("job", 0, 2 * label_row());
    label_within(c.area.left, c.area.top, c.area.right - c.area.left - 70 * s, ui_rgba(UI_TEXT, 1),
                 j->name);
    label_right(c.area.right, c.area.top, ui_rgba(j->state == JOB_FAILED ? UI_ERROR : UI_DIM, 1),
                words[j->state]);
    label_within(c.area.left, c.area.top + label_height() + 2 * s, c.area.right - c.area.left,
                 ui_rgba(UI_DIM, 1), j->said);
    ui_rect bar = {c.area.left, c.area.bottom - 3 * s, c.area.right, c.area.bottom - s};
    ui_fill(bar, ui_rgba(UI_LINE, 1), s);
    bar.right = bar.left + (bar.right - bar.left) * (float)fmin(j->part, 1);
    ui_fill(bar, ui_rgba(UI_ACCENT, 1), s);
    ui_canvas_end();
    bool off = false;
    if (label_switch(j->state == JOB_RUNS ? "Stop" : "Remove", &off, ui_rgba(UI_ACCENT, 1))) {
        if (j->state == JOB_RUNS)
            job_end(j, true);
        else
            forget(q, index);
    }
    ui_pop();
}

void render_queue_draw(live *l) {
    render_queue *q = l->queue;
    if (!q->open) return;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, true);
    if (ui_window_begin("Render", &q->open, where, false)) {
        draw_fields(q);
        ui_width(0);
        ui_disable_begin(!l->effect || !q->output[0]);
        ui_rect button = ui_space();
        button.bottom = button.top + ui_line_height();
        ui_mark("render add", button);
        if (ui_button("Add to the queue")) ask(l, q);
        ui_disable_end();
        if (q->count) ui_separator();
        for (size_t i = 0; i < q->count; i++) draw_job(q, i);
    }
    ui_window_end();
}
