// Parts of the work, for machines that share it and may be stopped anywhere.
#include "app/app.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <stdlib.h>
#include <string.h>

bool app_parse_shard(const char *text, unsigned *shard, unsigned *shards) {
    char rest;
    if (sscanf(text, "%6u/%6u%c", shard, shards, &rest) == 2 && *shard >= 1 && *shard <= *shards)
        return true;
    return err_set("--shard '%s'; accepted: 2/4, the second of four parts", text);
}

void app_cut_frames(app_frames *frames, unsigned shard, unsigned shards) {
    size_t begin = frames->count * (shard - 1) / shards, end = frames->count * shard / shards;
    memmove(frames->numbers, frames->numbers + begin, (end - begin) * sizeof *frames->numbers);
    frames->count = end - begin;
}

void app_skip_frames(app_frames *frames, bool (*there)(void *user, double frame), void *user) {
    size_t left = 0;
    for (size_t i = 0; i < frames->count; i++)
        if (!there(user, frames->numbers[i])) frames->numbers[left++] = frames->numbers[i];
    frames->count = left;
}

// ---- checkpoints ------------------------------------------------------------------------------

typedef struct numbered {
    double number;
    const char *path;
} numbered;

static int by_number(const void *a, const void *b) { // the highest first
    double x = ((const numbered *)a)->number, y = ((const numbered *)b)->number;
    return (x < y) - (x > y);
}

// Reads the number of a file that a pattern names. False: it does not name it so.
static bool read_number(const char *pattern, const char *path, double *out) {
    char again[PATH_CAP], *end;
    size_t before = (size_t)(strchr(pattern, '%') - pattern);
    if (strlen(path) <= before) return false;
    *out = (double)strtoul(path + before, &end, 10);
    app_format_pattern(pattern, *out, again, sizeof again);
    return strcmp(again, path) == 0;
}

static bool list_files(const char *pattern, file_list *out) {
    const char *mark = strchr(pattern, '%'), *after = strchr(mark, 'd') + 1;
    strbuf glob = {0};
    strbuf_add(&glob, "%.*s*%s", (int)(mark - pattern), pattern, after);
    bool done = file_glob(strbuf_text(&glob), out);
    strbuf_free(&glob);
    return done;
}

bool app_restore_last(roil_effect *e, const char *pattern, double most, double *frame) {
    file_list files = {0};
    if (!list_files(pattern, &files)) return false;
    numbered *states = mem_alloc(files.count * sizeof *states);
    size_t count = 0;
    for (size_t i = 0; i < files.count; i++) {
        numbered *s = &states[count];
        s->path = files.paths[i];
        count += read_number(pattern, s->path, &s->number) && s->number <= most;
    }
    qsort(states, count, sizeof *states, by_number);
    bool done = false;
    for (size_t i = 0; !done && i < count; i++) {
        done = roil_restore(e, states[i].path, frame);
        if (!done) log_write(LOG_WARNING, "%s; the one before is tried", roil_error());
    }
    mem_free(states);
    file_list_free(&files);
    return done;
}
