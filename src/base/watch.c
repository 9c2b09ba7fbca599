// One inotify descriptor and one thread. Files are looked up by "folder/name", folders by the
// number that inotify gave their watch; two names of one folder share a number.
//
// Instead of a missing folder, its nearest existing ancestor is watched. Whenever a folder appears,
// disappears or is moved, all watches are set again. For an unchanged folder inotify returns the
// number that it has already, so a different number reveals what changed.
#include "base/watch.h"
#include "base/arena.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include <errno.h>
#include <fnmatch.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    FOLDER_MASK = IN_CLOSE_WRITE | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO |
                  IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR,
    NO_WATCH = -1,
};

typedef struct watch_file {
    const char *key;  // "folder/name"
    const char *path; // as given
    size_t folder;
    bool pattern; // the name has wildcards
    bool changed; // to be reported
} watch_file;

typedef struct watch_folder {
    const char *path;
    int number; // of inotify; NO_WATCH: gone
    int above;  // while it is gone: that of an ancestor
} watch_folder;

typedef struct watch_list {
    arena memory;
    watch_file *files; // sorted by key; a file that is a link is here twice
    watch_folder *folders;
    size_t file_count, file_capacity, folder_count, folder_capacity;
} watch_list;

struct watch {
    watch_desc desc;
    int events, stop; // inotify; an eventfd
    pthread_t thread;
    pthread_mutex_t reporting; // one thread at a time
    pthread_mutex_t lock;      // guards `list` and `given`
    watch_list list;
    char **given; // as of the last watch_set
    size_t given_count;
};

// ---- the list ---------------------------------------------------------------------------------

static size_t add_folder(watch_list *list, const char *path) {
    for (size_t i = list->folder_count; i-- > 0;) // most files lie in the folder of the one before
        if (strcmp(list->folders[i].path, path) == 0) return i;
    MEM_RESERVE(list->folders, list->folder_count + 1, list->folder_capacity);
    list->folders[list->folder_count] =
        (watch_folder){arena_string(&list->memory, path), NO_WATCH, NO_WATCH};
    return list->folder_count++;
}

static void add_file(watch_list *list, const char *where, const char *path) {
    char folder[PATH_CAP], key[PATH_CAP];
    path_folder(folder, where);
    if (!path_join(key, folder, path_name(where))) return;
    *MEM_ADD(list->files, list->file_count, list->file_capacity) = (watch_file){
        .key = arena_string(&list->memory, key),
        .path = path,
        .folder = add_folder(list, folder),
        .pattern = strpbrk(path_name(where), "*?[") != NULL,
    };
}

static int by_key(const void *a, const void *b) {
    return strcmp(((const watch_file *)a)->key, ((const watch_file *)b)->key);
}

static watch_list make_list(const char *const *paths, size_t count) {
    watch_list list = {0};
    for (size_t i = 0; i < count; i++) {
        char real[PATH_MAX];
        const char *path = arena_string(&list.memory, paths[i]);
        add_file(&list, path, path);
        if (realpath(path, real) && strcmp(real, path) != 0) add_file(&list, real, path);
    }
    if (list.file_count) qsort(list.files, list.file_count, sizeof *list.files, by_key);
    return list;
}

static void free_list(watch_list *list) {
    mem_free(list->files);
    mem_free(list->folders);
    arena_free(&list->memory);
}

static void list_mark(watch_list *list, const char *key) {
    size_t low = 0, high = list->file_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (strcmp(list->files[middle].key, key) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < list->file_count && strcmp(list->files[low].key, key) == 0; low++)
        list->files[low].changed = true;
}

static void mark_patterns(watch_list *list, size_t folder, const char *name) {
    for (size_t i = 0; i < list->file_count; i++) {
        watch_file *file = &list->files[i];
        if (file->pattern && file->folder == folder &&
            fnmatch(path_name(file->key), name, FNM_PERIOD) == 0)
            file->changed = true;
    }
}

static void mark_folder(watch_list *list, size_t folder) { // SIZE_MAX: all
    for (size_t i = 0; i < list->file_count; i++)
        if (folder == SIZE_MAX || list->files[i].folder == folder) list->files[i].changed = true;
}

// ---- folders ----------------------------------------------------------------------------------

// Watches the nearest ancestor that exists.
static int watch_above(const watch *w, const char *path) {
    char folder[PATH_CAP], above[PATH_CAP];
    path_folder(folder, path);
    for (;;) {
        int number = inotify_add_watch(w->events, folder, FOLDER_MASK);
        path_folder(above, folder);
        if (number >= 0 || strcmp(above, folder) == 0) return number;
        memcpy(folder, above, sizeof folder);
    }
}

// Looks for the folder three times, so that one that appears between two looks is still seen.
static bool folder_arm(const watch *w, watch_folder *folder) {
    folder->above = NO_WATCH;
    for (int looks = 0; looks < 2; looks++) {
        folder->number = inotify_add_watch(w->events, folder->path, FOLDER_MASK);
        if (folder->number >= 0) return true;
        if (errno == ENOSPC || errno == ENOMEM)
            return err_set("%s: the system's limit of watched folders is reached "
                           "(fs.inotify.max_user_watches)",
                           folder->path);
        if (looks == 0) folder->above = watch_above(w, folder->path);
    }
    return true;
}

static bool is_used(const watch_list *list, int number) {
    for (size_t i = 0; i < list->folder_count; i++)
        if (list->folders[i].number == number || list->folders[i].above == number) return true;
    return false;
}

static void drop_unused(const watch *w, const watch_list *list, int number) {
    if (number >= 0 && !is_used(list, number)) inotify_rm_watch(w->events, number);
}

// Sets all watches again. Files in folders that are not the same any more count as changed.
static void watch_refresh(watch *w) {
    watch_list *list = &w->list;
    for (size_t i = 0; i < list->folder_count; i++) {
        watch_folder *folder = &list->folders[i], old = *folder;
        folder_arm(w, folder); // at a limit some folders stay unwatched, which watch_set told
        if (folder->number != old.number) mark_folder(list, i);
        drop_unused(w, list, old.number);
        drop_unused(w, list, old.above);
    }
}

// ---- events -----------------------------------------------------------------------------------

// Returns whether a name that appeared is complete. A file that is being written is complete once
// it is closed; a link is complete at once.
static bool is_complete(const char *path) {
    struct stat info;
    return lstat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_nlink > 1;
}

static void take_name(watch *w, const struct inotify_event *event) {
    for (size_t i = 0; i < w->list.folder_count; i++) {
        char path[PATH_CAP];
        if (w->list.folders[i].number != event->wd ||
            !path_join(path, w->list.folders[i].path, event->name))
            continue;
        if ((event->mask & IN_CREATE) && !is_complete(path)) continue;
        list_mark(&w->list, path);
        mark_patterns(&w->list, i, event->name);
    }
}

// Handles one event. True when folders must be looked for again.
static bool take_event(watch *w, const struct inotify_event *event) {
    if (event->mask & IN_Q_OVERFLOW) { // events were lost
        mark_folder(&w->list, SIZE_MAX);
        return true;
    }
    if (event->len && is_used(&w->list, event->wd)) take_name(w, event);
    if (event->mask & IN_MOVE_SELF) { // the watch went with the folder
        inotify_rm_watch(w->events, event->wd);
        return true;
    }
    if (event->mask & IN_IGNORED) return is_used(&w->list, event->wd);
    return event->mask & (IN_DELETE_SELF | IN_ISDIR);
}

static void take_all(watch *w) {
    union {
        struct inotify_event align;
        char bytes[64 << 10];
    } buffer;
    bool folders = false;
    for (;;) {
        ssize_t size = read(w->events, buffer.bytes, sizeof buffer.bytes);
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) break;
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event = (const void *)(buffer.bytes + at);
            folders = take_event(w, event) || folders;
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    if (folders) watch_refresh(w);
}

// Calls the callbacks without the lock, so that they may call watch_set.
static void watch_report(watch *w) {
    arena memory = {0};
    const char **paths = NULL;
    size_t count = 0, capacity = 0;
    pthread_mutex_lock(&w->reporting);
    pthread_mutex_lock(&w->lock);
    double when = clock_seconds();
    take_all(w);
    for (size_t i = 0; i < w->list.file_count; i++) {
        watch_file *file = &w->list.files[i];
        if (!file->changed) continue;
        file->changed = false;
        *MEM_ADD(paths, count, capacity) = arena_string(&memory, file->path);
    }
    pthread_mutex_unlock(&w->lock);
    for (size_t i = 0; i < count; i++) w->desc.changed(w->desc.user, paths[i], when);
    if (count && w->desc.settled) w->desc.settled(w->desc.user);
    pthread_mutex_unlock(&w->reporting);
    mem_free(paths);
    arena_free(&memory);
}

static void *watch_run(void *user) {
    watch *w = user;
    struct pollfd ready[] = {{.fd = w->events, .events = POLLIN},
                             {.fd = w->stop, .events = POLLIN}};
    for (;;) {
        int found = poll(ready, COUNT_OF(ready), -1);
        if (found < 0 && errno == EINTR) continue;
        if (found < 0 || ready[1].revents) return NULL;
        watch_report(w);
    }
}

// ---- public -----------------------------------------------------------------------------------

static void watch_release(watch *w) { // its thread has ended
    close(w->events);
    close(w->stop);
    pthread_mutex_destroy(&w->reporting);
    pthread_mutex_destroy(&w->lock);
    free_list(&w->list);
    for (size_t i = 0; i < w->given_count; i++) mem_free(w->given[i]);
    mem_free(w->given);
    mem_free(w);
}

watch *watch_create(const watch_desc *desc) {
    int events = inotify_init1(IN_NONBLOCK | IN_CLOEXEC), stop = eventfd(0, EFD_CLOEXEC);
    if (events < 0 || stop < 0) {
        err_set("files cannot be watched: %s", strerror(errno));
        if (events >= 0) close(events);
        if (stop >= 0) close(stop);
        return NULL;
    }
    watch *w = mem_alloc(sizeof *w);
    *w = (watch){.desc = *desc, .events = events, .stop = stop};
    pthread_mutex_init(&w->reporting, NULL);
    pthread_mutex_init(&w->lock, NULL);
    int failed = pthread_create(&w->thread, NULL, watch_run, w);
    if (!failed) return w;
    err_set("files cannot be watched: no thread can be made: %s", strerror(failed));
    watch_release(w);
    return NULL;
}

void watch_destroy(watch *w) {
    if (!w) return;
    eventfd_write(w->stop, 1);
    pthread_join(w->thread, NULL);
    watch_release(w);
}

static bool is_given(const watch *w, const char *const *paths, size_t count) {
    if (w->given_count != count) return false;
    for (size_t i = 0; i < count; i++)
        if (strcmp(w->given[i], paths[i]) != 0) return false;
    return true;
}

static void keep_given(watch *w, const char *const *paths, size_t count) {
    for (size_t i = 0; i < w->given_count; i++) mem_free(w->given[i]);
    mem_free(w->given);
    w->given = mem_alloc(count * sizeof *w->given);
    for (size_t i = 0; i < count; i++) w->given[i] = mem_copy(paths[i], strlen(paths[i]) + 1);
    w->given_count = count;
}

// Copies what was seen of a folder that stays on the list, so that a change since then is not
// missed: its event is still to be read, and its files are then reported.
static void list_compare(watch_list *list, const watch_list *old) {
    for (size_t i = 0; i < list->folder_count; i++)
        for (size_t k = 0; k < old->folder_count; k++)
            if (strcmp(list->folders[i].path, old->folders[k].path) == 0 &&
                list->folders[i].number != old->folders[k].number)
                mark_folder(list, i);
}

bool watch_set(watch *w, const char *const *paths, size_t count) {
    bool done = true;
    pthread_mutex_lock(&w->lock);
    if (!is_given(w, paths, count)) {
        watch_list old = w->list;
        w->list = make_list(paths, count);
        keep_given(w, paths, count);
        for (size_t i = 0; i < w->list.folder_count; i++)
            done = folder_arm(w, &w->list.folders[i]) && done;
        list_compare(&w->list, &old);
        for (size_t i = 0; i < old.folder_count; i++) {
            drop_unused(w, &w->list, old.folders[i].number);
            drop_unused(w, &w->list, old.folders[i].above);
        }
        free_list(&old);
    }
    pthread_mutex_unlock(&w->lock);
    return done;
}

void watch_catch_up(watch *w) {
    watch_report(w);
}
