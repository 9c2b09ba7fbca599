// roil live: what the parts of the window share. cmd_live.c has the loop; each part draws itself.
#pragma once
#include "app/app.h"
#include "app/orbit.h"
#include "app/timeline.h"
#include "ui/ui.h"

// Sizes of the picture, as shares of its view.
enum { LIVE_PREVIEWS = 3 };
typedef struct live_preview {
    const char *name; // "half"
    float scale;
} live_preview;
extern const live_preview live_previews[LIVE_PREVIEWS];

typedef struct live_session { // what is found again at the next start; session.c
    int x, y, width, height;  // of the window; width 0: none kept yet
    bool maximized;
    float panel; // width of the panel, units
    bool panel_hidden, performance, inspector, slices;
    char image[96]; // of the inspector
    int preview;    // of live_previews; -1: never chosen
} live_session;

typedef struct performance performance; // performance.c
typedef struct inspector inspector;     // inspector.c
typedef struct flow_tools flow_tools;   // flow_tools.c
typedef struct panel panel;             // panel.c

typedef struct live {
    roil *r;
    roil_live *follow;   // the effect and its files
    roil_effect *effect; // roil_live_effect of this frame; NULL: none is good yet
    const char *file;
    timeline time;
    orbit camera;
    bool camera_moved; // by hand: `camera` is in force, else the script's
    double start;      // frame to begin with; NAN: the effect's first
    bool dirty;        // the picture must be drawn again, though time stands still
    live_session session;
    bool help;
    bool quit, shot;     // asked for by a key
    char notice[512];    // said at the foot of the window for a while
    double notice_until; // clock_seconds
    char broken_text[2048];
    double broken_frame; // at which it broke; another one is tried
    bool held;           // after a hang: nothing is drawn until a file changes or time is started
    const char *broken;  // why no frame can be drawn, besides roil_live_message; NULL: it can
    performance *performance;
    inspector *inspector;
    flow_tools *flow_tools;
    panel *panel;
    uint32_t width, height; // of the effect's picture, pixels
    ui_rect view;           // where it is shown
    float pointer[2];       // in the picture, 0..1 from its top left
    struct window *window;
    const struct app_device *device;
    float slipped; // of the pointer, since it was pressed there (pixels)
} live;

// Sets a control by hand, and has the frame drawn again; what goes wrong becomes a notice.
void live_set(live *l, const char *name, const char *value);
void live_reset(live *l, const char *name); // NULL: all
void live_notice(live *l, const char *format, ...) __attribute__((format(printf, 2, 3)));
void live_break(live *l, const char *why); // no frame until something changes
// Draws and shows until the user quits. False with a message when nothing can be shown any more.
typedef struct window window; // window.h
bool live_loop(live *l, window *w);

// ---- camera_input.c: the camera in the user's hands
// ----------------------------------------------

void camera_input(live *l, const ui_canvas *view); // what the pointer does over the picture
void camera_frame(live *l);                        // so that the volume fills the picture
void camera_reset(live *l);                        // to the script's

// ---- event_input.c: what the effect hears
// ----------------------------------------------------------

enum { LIVE_HOTKEYS = 64 };
size_t event_hotkeys(const live *l, roil_hotkey out[LIVE_HOTKEYS]);
bool event_hears_key(const live *l, int key); // of GLFW
bool event_hears_clicks(const live *l);
bool event_press(live *l, int key, int mods, bool repeated); // true: the key was the effect's
void event_input(live *l, const ui_canvas *view);

// ---- parts, in the order in which they are drawn ----------------------------------------------

enum { TIMELINE_HEIGHT = 92 };              // units
void timeline_draw(live *l, ui_rect where); // timeline_bar.c

panel *panel_create(void);
void panel_destroy(panel *p);
void panel_draw(live *l, ui_rect where); // parameters, palettes, curves, passes, presets
// One editor each; true when the value changed. `id` keeps what is selected.
bool palette_draw(live *l, const char *name);
bool curve_draw(live *l, const char *name);

performance *performance_create(void);
void performance_destroy(performance *p);
// Once a frame of the effect that has been drawn; `cpu` and `interval` in seconds.
void performance_add(performance *p, roil_effect *e, double cpu, double interval);
void performance_draw(live *l);
double performance_rate(const performance *p); // frames per second of late; 0: unknown

inspector *inspector_create(void);
void inspector_destroy(inspector *p, roil *r);
// Before the interface is drawn, of an effect that was: draws the image into its texture.
void inspector_update(live *l);
void inspector_draw(live *l);

flow_tools *flow_tools_create(void);
void flow_tools_destroy(flow_tools *t, roil *r);
void flow_tools_update(live *l); // as the inspector's
void flow_tools_draw(live *l);   // slices { }: seen, pushed, captured, given templates

void status_draw(const live *l, ui_rect view); // what the effect says of itself
void overlay_draw(live *l, ui_rect view);      // the message of a broken file, and notices
void help_draw(live *l);                       // F1

// ---- keys ---------------------------------------------------------------------------------------

typedef struct live_key { // keys.c has the table; F1 lists it
    int key, mods;        // of GLFW
    const char *name;     // "Ctrl+S"
    const char *help;
    void (*run)(live *l);
} live_key;
const live_key *live_keys(size_t *count);
void live_press(live *l, int key, int mods, bool repeated); // of GLFW

// ---- session ------------------------------------------------------------------------------------

void session_load(live_session *s); // defaults where nothing is kept
void session_save(const live_session *s);
bool session_file(char *out, size_t capacity, const char *name); // in the user's folder of state
