// Events of a user: the keys that a script handles, and the text of all events with one more.
#include "effect/events.h"
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

size_t roil_hotkeys(const roil_effect *e, roil_hotkey *out, size_t capacity) {
    const effect_hearing *all;
    size_t count = effect_hearings(e->effect, &all);
    for (size_t i = 0; i < count && i < capacity; i++)
        out[i] = (roil_hotkey){all[i].key, all[i].help};
    return count;
}

// Stores the ray and not the position in the picture, since the camera may be elsewhere when the
// event is replayed.
char *roil_event_text(roil_effect *e, const char *key, float x, float y) {
    mem_enter();
    double now = effect_systems_time(e->effect);
    effect_event event = {.time = isfinite(now) ? now : 0, .numbers = 6};
    size_t count;
    const effect_event *before = effect_events(e->effect, &count);
    if (!str_copy(event.key, sizeof event.key, key))
        return roil_leave_text(ERR_NULL("key '%s' has too long a name", key));
    if (count >= EFFECT_MOST_EVENTS) {
        err_set("there are %zu events; at most %d are possible", count, EFFECT_MOST_EVENTS);
        return roil_leave_text(NULL);
    }
    if (!effect_camera_ray(e->effect, x, y, event.at, event.at + 3)) return roil_leave_text(NULL);
    effect_event *all = mem_alloc((count + 1) * sizeof *all);
    size_t at = 0; // behind those of its time
    for (size_t i = 0; i < count; i++) all[i + (before[i].time > event.time)] = before[i];
    while (at < count && before[at].time <= event.time) at++;
    all[at] = event;
    strbuf text = {0};
    events_print(all, count + 1, &text);
    mem_free(all);
    return roil_leave_text(text.text);
}
