// An effect that is rebuilt when its files change. Part of roil.h, which includes it; its rules
// on errors, threads and memory hold here too.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_live roil_live;

typedef struct roil_live_desc {
    const char *file;
    const char *const *presets; // as roil_read_preset takes them; read again when they change
    size_t preset_count;
    const roil_setting *settings; // win over presets
    size_t setting_count;
    // Called on another thread when roil_live_update has something to do. May be NULL.
    void (*wake)(void *user);
    void *user; // passed to wake
} roil_live_desc;

// Starts to watch the effect's files and to build it, on threads of its own, whenever one changes.
// A file that is broken is watched until it is mended: NULL is returned only without a device, when
// the file's folder cannot be watched, or when the file is a bundle and cannot be unpacked. What a
// bundle was when it was opened goes on.
roil_live *roil_live_create(roil *r, const roil_live_desc *desc);
// Cancels a build that is running, waits for it a second and frees `l`. Returns false when the
// build hangs: it keeps using the device and the memory, and roil_destroy then frees nothing. NULL
// is allowed.
bool roil_live_destroy(roil_live *l);
// Call it between frames: swaps in the effect that was built last, prepared for this size and with
// the histories of the old one. Returns true when the effect or the message has changed; handles of
// the old effect are then invalid. A size of 0 (a minimised window) swaps nothing in. `frame` is
// the frame that will be drawn next: an effect whose script fails at it is refused.
bool roil_live_update(roil_live *l, uint32_t width, uint32_t height, double frame);
void roil_live_wait(roil_live *l); // blocks until every change has been built
// Returns the last effect that could be built, owned by `l`; valid until roil_live_update returns
// true. NULL: none yet.
roil_effect *roil_live_effect(roil_live *l);
// Returns why the newest version could not be built, with the source line; NULL: it could. Valid
// until roil_live_update returns true.
const char *roil_live_message(roil_live *l);
// Sets a control of this effect and of those that are built later, until the script's own value of
// it changes. A structural control causes a build.
bool roil_live_set(roil_live *l, const char *name, const char *value);
bool roil_live_reset(roil_live *l, const char *name); // NULL: all controls
// Returns what a control is set to, as roil_live_set takes it; NULL: it has the script's own value.
// Free it with roil_free.
char *roil_live_setting(roil_live *l, const char *name);
typedef struct roil_live_count {
    uint64_t reloads, failures; // builds that were swapped in, and that failed
    double last; // seconds from the change of the file until its build was swapped in
} roil_live_count;
roil_live_count roil_live_counts(const roil_live *l);

#ifdef __cplusplus
}
#endif
