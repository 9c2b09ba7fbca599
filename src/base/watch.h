// Files that are watched for change, by inotify.
//
// Folders are watched rather than files, so that editors that write by rename, write twice, or
// delete first are all seen; a file that does not exist yet can be watched. What counts is that
// writing ended (the file was closed) or that a name appeared or went; a file that was only
// truncated is not reported before it is closed.
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct watch watch;

// `changed` is called from the watch's own thread with the path as it was given, and with the
// clock_seconds() at which the event was read; several changes that are there at once are all
// reported before `settled` is called once.
typedef struct watch_desc {
    void (*changed)(void *user, const char *path, double when);
    void (*settled)(void *user);
    void *user;
} watch_desc;

watch *watch_create(const watch_desc *desc); // NULL when the system gives no inotify
void watch_destroy(watch *w);                // joins its thread; NULL is fine
// Replaces the list. A path may have wildcards in its last component (fnmatch). Any thread. Folders
// that are gone are passed over, and found again when their parent folder shows them; false when
// the system's limit of watches is reached.
bool watch_set(watch *w, const char *const *paths, size_t count);
// Reports, from the calling thread, what happened before the call and was not reported yet.
void watch_catch_up(watch *w);
