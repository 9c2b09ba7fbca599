// Keys and clicks that the script of the effect handles. They become events of the control
// "effect.events", so that a jump in time, a reload and a picture's recipe have them.
#include "app/live.h"
#include <GLFW/glfw3.h>
#include <math.h>
#include <string.h>

static const float STILL = 4; // units that a click may slip

typedef struct key_name {
    int key; // of GLFW
    char name[8];
} key_name;

// Returns the name of a key. False: no effect can handle it.
static bool name_key(int key, char out[8]) {
    static const key_name names[] = {
        {GLFW_KEY_ENTER, "enter"}, {GLFW_KEY_UP, "up"}, {GLFW_KEY_DOWN, "down"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].key != key) continue;
        memcpy(out, names[i].name, sizeof names[i].name);
        return true;
    }
    bool letter = key >= GLFW_KEY_A && key <= GLFW_KEY_Z;
    out[0] = (char)(letter ? key - GLFW_KEY_A + 'a' : key);
    out[1] = '\0';
    return letter || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9);
}

size_t event_hotkeys(const live *l, roil_hotkey out[LIVE_HOTKEYS]) {
    size_t count = l->effect ? roil_hotkeys(l->effect, out, LIVE_HOTKEYS) : 0;
    return count < LIVE_HOTKEYS ? count : LIVE_HOTKEYS;
}

static bool is_heard(const live *l, const char *key) {
    roil_hotkey all[LIVE_HOTKEYS];
    size_t count = event_hotkeys(l, all);
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].key, key) == 0) return true;
    return false;
}

bool event_hears_key(const live *l, int key) {
    char name[8];
    return name_key(key, name) && is_heard(l, name);
}

static void event_send(live *l, const char *key) {
    char *text = roil_event_text(l->effect, key, l->pointer[0], l->pointer[1]);
    if (text)
        live_set(l, "effect.events", text);
    else
        live_notice(l, "%s", roil_error());
    roil_free(text);
}

bool event_press(live *l, int key, int mods, bool repeated) {
    const int used = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    char name[8];
    if ((mods & used) || !name_key(key, name) || !is_heard(l, name)) return false;
    if (!repeated) event_send(l, name);
    return true;
}

bool event_hears_clicks(const live *l) {
    return is_heard(l, "");
}

void event_input(live *l, const ui_canvas *view) {
    float width = view->area.right - view->area.left, height = view->area.bottom - view->area.top;
    if (view->hovered || view->held) {
        l->pointer[0] = fminf(fmaxf((view->x - view->area.left) / fmaxf(width, 1), 0), 1);
        l->pointer[1] = fminf(fmaxf((view->y - view->area.top) / fmaxf(height, 1), 0), 1);
    }
    if (view->pressed)
        l->slipped = 0;
    else if (view->held)
        l->slipped += fabsf(view->dx) + fabsf(view->dy);
    if (view->released && l->slipped <= STILL * ui_scale() && event_hears_clicks(l))
        event_send(l, "");
}
