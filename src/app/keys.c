// The keys of the live window: one table, which F1 shows.
#include "app/branches.h"
#include "app/drawing.h"
#include "app/render_queue.h"
#include "base/log.h"
#include "base/memory.h"
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double ENDLESS = 1, TIMES = 2; // seconds of a frame, and times the one before

// ---- what they do -----------------------------------------------------------------------------

static void key_play(live *l) {
    l->time.playing = !l->time.playing;
    l->dirty = true; // what was broken is tried again
    l->held = false;
    l->broken = NULL;
}

static void key_seek(live *l, double frame) {
    timeline_seek(&l->time, frame);
}

static void step_back(live *l) {
    timeline_step(&l->time, -1);
}

static void step_on(live *l) {
    timeline_step(&l->time, 1);
}

static void go_first(live *l) {
    key_seek(l, l->time.from);
}

static void go_last(live *l) {
    key_seek(l, l->time.to);
}

static void key_restart(live *l) {
    roil_simulation simulation;
    bool hears = l->effect && roil_hotkeys(l->effect, NULL, 0) > 0;
    if (!l->effect || (!hears && !roil_get_simulation(l->effect, &simulation))) return;
    if (hears) live_reset(l, "effect.events"); // what hands have done
    roil_restart(l->effect);
    live_redraw(l);
    live_notice(l, hears ? "Restarted without clicks and keys" : "Simulation restarted");
}

static void loop(live *l) {
    l->time.loop = !l->time.loop;
    live_notice(l, l->time.loop ? "Starts again at the end" : "Stops at the end");
}

static void key_preview(live *l) {
    l->session.preview = (l->session.preview + 1) % LIVE_PREVIEWS;
    live_notice(l, "Picture at %s size", live_previews[l->session.preview].name);
}

static void panels(live *l) {
    l->session.panel_hidden = !l->session.panel_hidden;
}

static void key_inspect(live *l) {
    l->session.inspector = !l->session.inspector;
}

static void slices(live *l) {
    l->session.slices = !l->session.slices;
}

static void key_handles(live *l) {
    l->session.handles = !l->session.handles;
}

static void key_probe(live *l) {
    l->session.probe = !l->session.probe;
}

static void key_graph(live *l) {
    l->session.graph = !l->session.graph;
}

static void key_ground(live *l) {
    l->session.ground = !l->session.ground;
}

static void performance_key(live *l) {
    l->session.performance = !l->session.performance;
}

static void help(live *l) {
    l->help = !l->help;
}

static void shot(live *l) {
    l->shot = true;
}

static void contrast(live *l) {
    l->session.contrast = !l->session.contrast;
}

// In steps of a tenth.
static void resize(live *l, float tenths) {
    session_resize(&l->session, tenths);
    live_notice(l, "Interface at %.0f %%", (double)l->session.scale * 100);
}

static void larger(live *l) {
    resize(l, 1);
}

static void smaller(live *l) {
    resize(l, -1);
}

static void walk(live *l) {
    ui_walk(ui_walks() || l->session.panel_hidden ? NULL : "panel");
    if (ui_walks()) live_notice(l, "Arrows, Tab and Enter use the panel; Esc or F6 leaves it");
}

static void key_quit(live *l) {
    l->quit = true;
}

// Goes back to the time that a simulation has reached. False: none is behind.
static bool stop_simulating(live *l) {
    roil_simulation s;
    if (!l->effect || !drawing_is_behind(l) || !roil_get_simulation(l->effect, &s) ||
        !isfinite(s.reached))
        return false;
    l->time.playing = false;
    key_seek(l, fmax(l->time.from, floor(l->time.first + s.reached * l->time.fps + 1e-6)));
    live_notice(l, "Stopped at %.2f s", s.reached);
    return true;
}

// A frame that goes on and on: its device is given up, and the program starts anew without it. One
// that takes no longer than the one before it is waited for.
static void stop_drawing(live *l) {
    double frame, seconds, usual;
    if (!drawing_is_busy(l, &frame, &seconds, &usual)) return;
    l->time.playing = false;
    if (seconds < fmax(ENDLESS, TIMES * usual)) return;
    roil_give_up(l->r);
    live_break(l, roil_error());
}

static void close_top(live *l) {
    if (stop_simulating(l)) return;
    if (l->help)
        l->help = false;
    else if (render_queue_close(l))
        return;
    else if (l->writing)
        write_back_close(l);
    else if (l->undo_list)
        l->undo_list = false;
    else if (l->session.slices)
        l->session.slices = false;
    else if (l->session.inspector)
        l->session.inspector = false;
    else if (l->session.graph)
        l->session.graph = false;
    else if (l->session.performance)
        l->session.performance = false;
    else
        stop_drawing(l);
}

// Saves under the first free name of a series, since a key cannot ask and must not replace a file.
// The panel saves under a chosen name.
static void save_preset(live *l) {
    char names[64][64], name[64];
    if (!l->effect) return;
    size_t count = roil_presets(l->file, names, COUNT_OF(names)), number = 1;
    for (bool taken = true; taken; number++) {
        snprintf(name, sizeof name, "preset-%zu", number);
        taken = false;
        for (size_t i = 0; i < count && i < COUNT_OF(names); i++)
            taken = taken || strcmp(names[i], name) == 0;
    }
    if (!live_write_preset(l, name)) return;
    log_write(LOG_DEBUG, "live: wrote preset %s", name);
    live_notice(l, "Saved preset \"%s\"", name);
}

static void write_back_key(live *l) {
    write_back_ask(l, NULL);
}

static void undo_list(live *l) {
    l->undo_list = !l->undo_list;
}

// ---- table ------------------------------------------------------------------------------------

static const live_key keys[] = {
    {GLFW_KEY_SPACE, 0, "Space", "play, pause", key_play},
    {GLFW_KEY_LEFT, 0, "Left", "one frame back", step_back},
    {GLFW_KEY_RIGHT, 0, "Right", "one frame on", step_on},
    {GLFW_KEY_HOME, 0, "Home", "first frame of the range", go_first},
    {GLFW_KEY_END, 0, "End", "last frame of the range", go_last},
    {GLFW_KEY_L, 0, "L", "start again at the end, or stop", loop},
    {GLFW_KEY_BACKSPACE, 0, "Backspace", "restart without clicks and keys", key_restart},
    {GLFW_KEY_B, 0, "B", "branch off from this frame", branches_fork},
    {GLFW_KEY_X, 0, "X", "the next branch", branches_next},
    {GLFW_KEY_C, 0, "C", "compare two branches side by side", branches_compare},
    {GLFW_KEY_F, 0, "F", "frame the volume", camera_frame},
    {GLFW_KEY_R, 0, "R", "camera of the effect file", camera_reset},
    {GLFW_KEY_H, 0, "H", "handles in the picture, to be dragged", key_handles},
    {GLFW_KEY_G, 0, "G", "a grid on the ground", key_ground},
    {GLFW_KEY_D, 0, "D", "what is under the pointer: density and what grids hold", key_probe},
    {GLFW_KEY_1, 0, "1", "look from the front, without perspective", camera_front},
    {GLFW_KEY_2, 0, "2", "look from the right", camera_side},
    {GLFW_KEY_3, 0, "3", "look from above", camera_top},
    {GLFW_KEY_0, 0, "0", "look with perspective again", camera_perspective},
    {GLFW_KEY_V, 0, "V", "picture at full, half, quarter size", key_preview},
    {GLFW_KEY_TAB, 0, "Tab", "show the picture alone", panels},
    {GLFW_KEY_I, 0, "I", "inspect the images of passes", key_inspect},
    {GLFW_KEY_N, 0, "N", "the graph: passes, their times and images", key_graph},
    {GLFW_KEY_S, 0, "S", "see, push and capture the flow of slices", slices},
    {GLFW_KEY_P, 0, "P", "performance", performance_key},
    {GLFW_KEY_R, GLFW_MOD_CONTROL, "Ctrl+R", "render pictures or a video", render_queue_open},
    {GLFW_KEY_F12, 0, "F12", "save the picture as PNG", shot},
    {GLFW_KEY_Z, GLFW_MOD_CONTROL, "Ctrl+Z", "undo", live_undo},
    {GLFW_KEY_Y, GLFW_MOD_CONTROL, "Ctrl+Y", "do again", live_redo},
    {GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, "Ctrl+Shift+Z", "do again", live_redo},
    {GLFW_KEY_U, 0, "U", "list what was done", undo_list},
    {GLFW_KEY_W, 0, "W", "write what was changed into the file", write_back_key},
    {GLFW_KEY_S, GLFW_MOD_CONTROL, "Ctrl+S", "save a preset", save_preset},
    {GLFW_KEY_O, GLFW_MOD_CONTROL, "Ctrl+O", "open another effect: the start page",
     live_start_page},
    {GLFW_KEY_F2, 0, "F2", "high contrast", contrast},
    {GLFW_KEY_F6, 0, "F6", "use the panel by keys", walk},
    {GLFW_KEY_EQUAL, GLFW_MOD_CONTROL, "Ctrl+=", "larger letters and widgets", larger},
    {GLFW_KEY_MINUS, GLFW_MOD_CONTROL, "Ctrl+-", "smaller ones", smaller},
    {GLFW_KEY_F1, 0, "F1", "this help", help},
    {GLFW_KEY_ESCAPE, 0, "Esc", "stop what works, or close what lies on top", close_top},
    {GLFW_KEY_Q, GLFW_MOD_CONTROL, "Ctrl+Q", "quit", key_quit},
};

const live_key *live_keys(size_t *count) {
    *count = COUNT_OF(keys);
    return keys;
}

// Keys that an effect handles come first; with Alt they do what they do in the window.
void live_press(live *l, int key, int mods, bool repeated) {
    const int used = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    if (event_press(l, key, mods, repeated)) return;
    if ((mods & used) == GLFW_MOD_ALT && event_hears_key(l, key)) mods = 0;
    for (size_t i = 0; i < COUNT_OF(keys); i++) {
        if (keys[i].key != key || keys[i].mods != (mods & used)) continue;
        if (!repeated || keys[i].run == step_back || keys[i].run == step_on ||
            keys[i].run == live_undo || keys[i].run == live_redo)
            keys[i].run(l);
        return;
    }
}
