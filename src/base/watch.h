// Watches files for changes, by inotify.
//
// Folders are watched rather than files, so that changes are seen whether an editor renames a new
// file, writes twice or deletes the file first. A file need not exist yet. It has changed when it
// was closed after writing, or when its name appeared or disappeared; a file that was only
// truncated is not reported before it is closed.
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct watch watch;

// `changed` is called on the watch's own thread with the path as it was given, and with the
// clock_seconds() when the event was read. Several changes at once are all reported before
// `settled` is called once.
typedef struct watch_desc {
    void (*changed)(void *user, const char *path, double when);
    void (*settled)(void *user);
    void *user;
} watch_desc;

watch *watch_create(const watch_desc *desc); // NULL with a message when there is no inotify
void watch_destroy(watch *w);                // joins its thread; NULL is allowed
// Replaces the list of watched files. A path may have wildcards in its last component (fnmatch).
// Missing folders are skipped, and found again when their parent folder has them. False when the
// system's limit of watches is reached. Any thread.
bool watch_set(watch *w, const char *const *paths, size_t count);
// Reports, on the calling thread, all changes before the call that were not reported yet.
void watch_catch_up(watch *w);
