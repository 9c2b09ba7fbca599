// roil live: the state shared by the parts of the window. live.c has the loop; each part draws
// itself.
#pragma once
#include "app/app.h"
#include "app/orbit.h"
#include "app/pulse.h"
#include "app/timeline.h"
#include "app/undo.h"
#include "ui/ui.h"

// Sizes of the picture, relative to its view.
enum { LIVE_PREVIEWS = 3 };
typedef struct live_preview {
    const char *name; // "half"
    float scale;
} live_preview;
extern const live_preview live_previews[LIVE_PREVIEWS];

typedef struct live_session { // what is restored at the next start; session.c
    int x, y, width, height;  // of the window; width 0: not known yet
    bool maximized;
    float panel; // width of the panel, units
    bool panel_hidden, performance, inspector, slices;
    bool handles, ground, probe; // are shown over the picture
    bool graph, contrast;
    float scale;    // of the interface, as the user has it: 0.5 to 3
    char image[96]; // shown by the inspector
    int preview;    // index in live_previews; -1: never chosen
} live_session;

typedef struct branches branches;         // branches.h
typedef struct drawing drawing;           // drawing.h
typedef struct performance performance;   // performance.c
typedef struct inspector inspector;       // inspector.c
typedef struct flow_tools flow_tools;     // flow_tools.c
typedef struct panel panel;               // panel.c
typedef struct render_queue render_queue; // render_queue.h
typedef struct write_back write_back;     // write_back.c
typedef struct handles handles;           // handles.c
typedef struct graph_view graph_view;     // graph_view.c

typedef struct live_probe { // what was found under the pointer last; probe.c
    roil_probed found;
    float x, y;            // where in the picture
    const roil_effect *of; // NULL: nothing was
    uint64_t picture;      // live.pictures then
    char why[256];         // it could not be found out
} live_probe;

typedef struct live {
    roil *r;
    roil_live *follow;   // the effect and its files
    roil_effect *effect; // roil_live_effect of this frame; NULL: none yet
    const char *file;
    timeline time;
    orbit camera;
    bool camera_moved; // by the user: `camera` is used, else the script's
    double start;      // frame to begin with; NAN: the effect's first
    bool dirty;        // the picture of now must be drawn again
    live_session session;
    bool help;
    bool quit, shot; // requested by a key
    bool leaves;     // for `next`, and where that has no file for the start page
    struct opening *next;
    char notice[512];    // shown at the bottom of the window for a while
    double notice_until; // clock_seconds
    char broken_text[2048];
    double broken_frame; // the frame that failed; another one is tried
    bool held;           // after a hang: nothing is drawn until a file changes or the user plays
    const char *broken;  // why no frame can be drawn, besides roil_live_message; NULL: it can be
    pulse pulse;
    drawing *drawing;
    branches *branches;
    render_queue *queue;
    performance *performance;
    inspector *inspector;
    flow_tools *flow_tools;
    panel *panel;
    handles *handles;
    graph_view *graph;
    undo undo;
    bool undo_list;   // is shown
    bool awaits_file; // a step wrote files, which are not loaded yet; then on to `goal`
    size_t goal;      // steps that shall hold
    size_t restored;  // step, from 1, whose values are set once its file is loaded; 0: none
    live_probe probe;
    uint64_t pictures;      // that were drawn
    write_back *writing;    // what the user is asked to write; NULL: nothing
    uint32_t width, height; // of the effect's picture, pixels
    ui_rect whole;          // the window
    ui_rect view;           // where the picture is shown
    float pointer[2];       // position in the picture, 0 to 1 from its top left
    struct window *window;
    const struct app_device *device;
    struct {
        double since, from; // clock_seconds when a simulation fell behind (0: it is not), and
                            // which time it had reached then
    } behind;
    float slipped; // how far the pointer moved since the button went down (pixels)
} live;

void live_redraw(live *l); // draws the frame again; what was broken may work now
void live_notice(live *l, const char *format, ...) __attribute__((format(printf, 2, 3)));
void live_break(live *l, const char *why); // draws no frame until something changes
// Runs the window until the user quits. False with a message when nothing can be shown any more.
typedef struct window window; // window.h
bool live_loop(live *l, window *w);

void live_start_page(live *l); // leaves the effect for it (cmd_live.c)

// ---- changes.c: all that a hand changes, and undoing it -----------------------------------------

// Sets a control for the user and has the frame drawn again. A failure is shown as a notice.
void live_set(live *l, const char *name, const char *value);
void live_reset(live *l, const char *name); // NULL: all controls
// Has `write` make or replace a file below the effect's folder, as a step that can be undone.
// False, and a notice, when that fails.
bool live_write(live *l, const char *path, const char *label, bool (*write)(live *l, void *user),
                void *user);
bool live_write_preset(live *l, char *name); // in the same way
void live_undo(live *l);
void live_redo(live *l);
void changes_take_over(live *l); // call it when the effect was loaded anew
void changes_draw(live *l);      // the list of what was done

// ---- write_back.c: what was changed is written into the effect's files --------------------------

void write_back_ask(live *l, const char *control); // NULL: every control that was changed
void write_back_pin(live *l, const char *control); // becomes a parameter
// For a list of layers of noise to have one more or one less.
void write_back_layer(live *l, const char *layers, size_t layer, roil_layer_change how);
void write_back_draw(live *l); // shows what will change
void write_back_close(live *l);

// ---- camera_input.c: the user moves the camera --------------------------------------------------

void camera_input(live *l, const ui_canvas *view); // handles the pointer over the picture
void camera_frame(live *l);                        // makes the volume fill the picture
void camera_reset(live *l);                        // returns to the script's camera
// Look along an axis without perspective; and with perspective again.
void camera_front(live *l);
void camera_side(live *l);
void camera_top(live *l);
void camera_perspective(live *l);

// ---- handles.c: what stands in space is seen and dragged in the picture -------------------------

handles *handles_create(void);
void handles_destroy(handles *h);
bool handles_input(live *l, const ui_canvas *view); // true: they have the pointer
void handles_draw(const live *l);                   // the grid on the ground too

// ---- probe.c: what fills space under the pointer ------------------------------------------------

void probe_draw(live *l, const ui_canvas *view);

// ---- event_input.c: keys and clicks that the effect's script handles ----------------------------

enum { LIVE_HOTKEYS = 64 };
size_t event_hotkeys(const live *l, roil_hotkey out[LIVE_HOTKEYS]);
bool event_hears_key(const live *l, int key); // a key of GLFW
bool event_hears_clicks(const live *l);
bool event_press(live *l, int key, int mods, bool repeated); // true: the effect handles the key
void event_input(live *l, const ui_canvas *view);

// ---- parts, in the order in which they are drawn ----------------------------------------------

enum { TIMELINE_HEIGHT = 92 };              // units
void timeline_draw(live *l, ui_rect where); // timeline_bar.c

panel *panel_create(void);
void panel_destroy(panel *p);
void panel_draw(live *l, ui_rect where);      // parameters, palettes, curves, passes, presets
void panel_find(live *l, const char *search); // shows what matches
// Draw the editor of a palette or a curve. True when the value changed.
bool palette_draw(live *l, const char *name);
bool curve_draw(live *l, const char *name);

performance *performance_create(void);
void performance_destroy(performance *p);
// Adds a frame of the effect that was drawn. `cpu` and `interval` are seconds.
void performance_add(performance *p, roil_effect *e, double cpu, double interval);
void performance_draw(live *l);
// Returns the milliseconds that a pass took in the last frame; below 0: not known.
double performance_time(const performance *p, const char *pass);
double performance_rate(const performance *p); // recent frames per second; 0: unknown

inspector *inspector_create(void);
void inspector_destroy(inspector *p, roil *r);
// Draws the image into its texture. Call it after the effect and before the interface is drawn.
void inspector_update(live *l);
void inspector_draw(live *l);

graph_view *graph_view_create(void);
void graph_view_destroy(graph_view *g, roil *r);
void graph_view_update(live *l);     // like inspector_update
bool graph_view_busy(const live *l); // it has pictures to make
void graph_view_draw(live *l);       // the window "Graph"

flow_tools *flow_tools_create(void);
void flow_tools_destroy(flow_tools *t, roil *r);
void flow_tools_update(live *l); // like inspector_update
void flow_tools_draw(live *l);   // the window "Slices"

void status_draw(const live *l, ui_rect view); // values that the effect reports
void overlay_draw(live *l, ui_rect view);      // the message of a broken file, and notices
void help_draw(live *l);                       // F1

// ---- keys ---------------------------------------------------------------------------------------

typedef struct live_key { // a row of the table in keys.c, which F1 lists
    int key, mods;        // of GLFW
    const char *name;     // "Ctrl+S"
    const char *help;
    void (*run)(live *l);
} live_key;
const live_key *live_keys(size_t *count);
void live_press(live *l, int key, int mods, bool repeated); // of GLFW

// ---- session ------------------------------------------------------------------------------------

void session_load(live_session *s); // uses defaults for what was not saved
void session_save(const live_session *s);
void session_resize(live_session *s, float tenths); // the interface
// Returns the path of a file in the user's state folder.
bool session_file(char *out, size_t capacity, const char *name);
