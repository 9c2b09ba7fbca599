// roil live EFFECT.lua ...: a window in which an effect is tuned while it runs.
#include "app/branches.h"
#include "app/device_options.h"
#include "app/drawing.h"
#include "app/live.h"
#include "app/opening.h"
#include "app/recent.h"
#include "app/render_queue.h"
#include "app/restart.h"
#include "app/start.h"
#include "app/window.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <GLFW/glfw3.h>
#include <inttypes.h>
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct job {
    const char *file, *preview, *after_hang, *stats;
    app_settings settings;
    app_device device;
    uint32_t width, height;
    double frame;
    int paused, hidden_panel;
    opening chosen; // on the start page, or in the window, to be shown next
    bool again;     // something was
} job;

// ---- options ----------------------------------------------------------------------------------

static bool take_size(void *user, int option, char *text) {
    (void)option; // the only one
    job *j = user;
    return app_parse_size(text, &j->width, &j->height);
}

static int preview_of(const char *name) {
    for (int i = 0; i < LIVE_PREVIEWS; i++)
        if (strcmp(name, live_previews[i].name) == 0) return i;
    return -1;
}

static bool live_check_options(void *user, poptContext arguments) {
    job *j = user;
    if (poptPeekArg(arguments) && !app_take_effect(arguments, &j->file, "")) return false;
    if (j->preview && preview_of(j->preview) < 0)
        return err_set("--preview '%s'; accepted: full, half, quarter", j->preview);
    return app_check_device(&j->device);
}

// ---- work -------------------------------------------------------------------------------------

// Called while the device works on a long frame: the user can close the window or cancel the frame.
static bool on_waiting(void *user, double seconds) {
    live *l = user;
    window_busy answer = window_wait_busy(l->window, seconds);
    l->quit = l->quit || answer == WINDOW_QUIT;
    return answer == WINDOW_GOES_ON;
}

static void on_key(void *user, int key, int mods, bool again) {
    bool types = !(mods & GLFW_MOD_CONTROL) && key < GLFW_KEY_F1; // or moves in what is typed
    if (key == GLFW_KEY_ESCAPE && ui_walks() && !ui_types()) ui_walk(NULL);
    if (!(types && ui_wants_keys())) live_press(user, key, mods, again);
}

static void take_session(live *l, const job *j) {
    if (j->preview) l->session.preview = preview_of(j->preview);
    if (l->session.preview < 0) l->session.preview = roil_wants_preview(l->r) ? 1 : 0;
    if (j->hidden_panel) l->session.panel_hidden = true;
    if (!j->after_hang) return;
    l->held = true;
    live_break(l, j->after_hang);
}

static int run_window(live *l, window *w, const job *j) {
    char layout[PATH_CAP];
    if (!ui_open(w->handle, l->r,
                 session_file(layout, sizeof layout, "layout.ini") ? layout : NULL))
        return app_fail_input();
    ui_on_key(on_key, l);
    l->drawing = drawing_create();
    l->branches = branches_create();
    l->queue = render_queue_create();
    l->performance = performance_create();
    l->inspector = inspector_create();
    l->flow_tools = flow_tools_create();
    l->panel = panel_create();
    l->handles = handles_create();
    l->graph = graph_view_create();
    take_session(l, j);
    bool done = live_loop(l, w);
    drawing_end(l);
    render_queue_destroy(l->queue);
    restart_disarm();
    window_keep(w, &l->session);
    session_save(&l->session);
    bool told = !j->stats || pulse_save(&l->pulse, j->stats, drawing_count(l));
    if (roil_is_lost(l->r) && !window_closing(w) && !l->quit) return restart(l, &j->device);
    int status = (done || roil_is_lost(l->r)) && told ? APP_DONE : app_fail_input();
    if (roil_is_lost(l->r)) { // its threads may never end
        fflush(NULL);
        _exit(status);
    }
    if (done && l->effect && l->pictures > 0) recent_add(l->file, l->effect);
    write_back_close(l);
    undo_free(&l->undo);
    panel_destroy(l->panel);
    handles_destroy(l->handles);
    graph_view_destroy(l->graph, l->r);
    flow_tools_destroy(l->flow_tools, l->r);
    inspector_destroy(l->inspector, l->r);
    performance_destroy(l->performance);
    branches_destroy(l->branches, l->r);
    drawing_destroy(l->drawing, l->r);
    ui_close();
    return status;
}

static int run_device(live *l, window *w, job *j) {
    roil_desc desc = app_device_desc(&j->device);
    desc.window = &w->desc;
    desc.never_waits = true;
    desc.interaction = true;
    desc.waiting = on_waiting;
    desc.user = l;
    l->window = w;
    l->device = &j->device;
    l->r = roil_create(&desc);
    if (!l->r) return app_fail_input();
    l->follow = roil_live_create(l->r, &(roil_live_desc){.file = j->file,
                                                         .presets = j->settings.presets,
                                                         .preset_count = j->settings.preset_count,
                                                         .settings = j->settings.sets,
                                                         .setting_count = j->settings.set_count,
                                                         .wake = window_wake});
    int status = l->follow ? run_window(l, w, j) : app_fail_input();
    if (!roil_live_destroy(
            l->follow)) { // nothing that its thread uses may be freed, by exit either
        log_write(LOG_WARNING, "live: %s", roil_error());
        fflush(NULL);
        _exit(status);
    }
    uint64_t complaints = roil_validation_messages(l->r);
    roil_destroy(l->r);
    if (status == APP_DONE && complaints)
        return app_fail(APP_BAD_INPUT, "%" PRIu64 " messages of the validation layers", complaints);
    return status;
}

// What was chosen is shown with the settings of its recipe, and without those of the last effect.
static void take_chosen(job *j) {
    const roil_recipe *recipe = j->chosen.recipe;
    app_free_settings(&j->settings);
    j->settings = (app_settings){.sets = NULL};
    j->file = j->chosen.file;
    j->frame = recipe ? recipe->frame : (double)NAN;
    j->after_hang = NULL;
    for (size_t i = 0; recipe && i < recipe->setting_count; i++) {
        app_settings *s = &j->settings;
        *MEM_ADD(s->sets, s->set_count, s->set_capacity) = recipe->settings[i];
    }
}

// Opens a file that was dropped on the window; no file: the start page.
static void open_next(live *l, const char *path) {
    opening found = {.recipe = NULL};
    if (path && !opening_find(roil_home(l->r), path, &found)) {
        live_notice(l, "%s", roil_error());
        return;
    }
    opening_free(l->next);
    *l->next = found;
    l->leaves = l->quit = true;
}

static void on_drop(void *user, const char *path) {
    open_next(user, path);
}

void live_start_page(live *l) {
    open_next(l, NULL);
}

// Goes on with what was opened in the window, if anything was.
static void take_next(job *j, const live *l, opening *next) {
    j->again = l->leaves;
    if (!j->again) return;
    opening_free(&j->chosen);
    j->chosen = *next;
    j->file = NULL;
    if (j->chosen.file[0]) take_chosen(j);
}

static int live_run_window(job *j) {
    opening next = {.recipe = NULL};
    live l = {.file = j->file, .start = j->frame, .next = &next};
    l.time.frame = isfinite(j->frame) ? j->frame : 1;
    l.time.playing = !j->paused;
    if (!j->after_hang && !app_check_effect(j->file)) return app_fail_input();
    session_load(&l.session);
    strbuf title = {0};
    strbuf_add(&title, "%s \u2013 roil", path_name(j->file));
    window w;
    bool opened = window_open(&w, &l.session, strbuf_text(&title), (int)j->width, (int)j->height);
    strbuf_free(&title);
    if (!opened) return app_fail(APP_BAD_INPUT, "live: %s", roil_error());
    window_on_drop(&w, on_drop, &l);
    int status = run_device(&l, &w, j);
    window_close(&w);
    take_next(j, &l, &next);
    return status;
}

// One window after the other: the start page, an effect, and what was opened in its window.
static int run_windows(void *user) {
    job *j = user;
    int status = APP_DONE;
    do {
        j->again = false;
        if (!j->file) {
            opening_free(&j->chosen);
            status = start_choose(&j->device, (int)j->width, (int)j->height, &j->chosen);
            if (status != APP_DONE || !j->chosen.file[0]) return status;
            take_chosen(j);
        }
        status = live_run_window(j);
    } while (status == APP_DONE && j->again);
    return status;
}

int cmd_live(int argc, const char **argv) {
    job j = {.frame = (double)NAN};
    const struct poptOption options[] = {
        {"size", 's', POPT_ARG_STRING, NULL, 1,
         "size of the window (default: that of the last time)", "WxH"},
        {"set", '\0', POPT_ARG_STRING, NULL, APP_SET,
         "a parameter, or a uniform or option of a pass (march.steps=64)", "NAME=VALUE"},
        {"preset", 'p', POPT_ARG_STRING, NULL, APP_PRESET,
         "values saved under a name beside the effect, or in a .lua file", "NAME"},
        APP_EVENT_ROW,
        {"frame", 'f', POPT_ARG_DOUBLE, &j.frame, 0,
         "first frame to show (default: the effect's first)", "FRAME"},
        {"paused", '\0', POPT_ARG_NONE, &j.paused, 0, "do not play at once", NULL},
        {"preview", '\0', POPT_ARG_STRING, &j.preview, 0,
         "size of the picture: full, half, quarter (default: that of the last time)", "SIZE"},
        {"stats", '\0', POPT_ARG_STRING, &j.stats, 0,
         "write how often the window was drawn and how soon it answered", "FILE.json"},
        {"hidden-panel", '\0', POPT_ARG_NONE, &j.hidden_panel, 0, "show the picture alone", NULL},
        app_device_rows(&j.device),
        {"after-hang", '\0', POPT_ARG_STRING | POPT_ARGFLAG_DOC_HIDDEN, &j.after_hang, 0, NULL,
         NULL},
        POPT_AUTOHELP POPT_TABLEEND};
    int status = app_run(argc, argv, "roil live", "[EFFECT.lua] [options]", options,
                         &(app_task){.job = &j,
                                     .check = live_check_options,
                                     .run = run_windows,
                                     .take = take_size,
                                     .settings = &j.settings});
    opening_free(&j.chosen);
    return status;
}
