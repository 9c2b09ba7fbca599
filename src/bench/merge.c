// Combines parts of one sweep that were measured separately.
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/sweep.h"
#include <string.h>

enum { PICTURE_MAX = 16 << 20 };

static bool copy_thumbnail(const bench_row *row, const char *from, const char *to) {
    char source[PATH_CAP], target[PATH_CAP];
    void *data;
    size_t size;
    if (!row->thumbnail || strcmp(from, to) == 0) return true;
    if (!path_join(source, from, row->thumbnail) || !path_join(target, to, row->thumbnail))
        return false;
    if (!file_read_inside(from, source, PICTURE_MAX, &data, &size)) return false;
    bool done = file_make_folders(to) && file_write_inside(to, target, data, size);
    mem_free(data);
    return done;
}

static bool is_same(const bench_results *a, const bench_results *b, const char *folder) {
    if (strcmp(a->content, b->content) != 0)
        return err_set("%s: is of another sweep ('%s', the first is '%s'), or of other options or "
                       "effects",
                       folder, b->sweep, a->sweep);
    return strcmp(a->commit, b->commit) == 0 ||
           err_set("%s: was measured at commit %s, the first at %s", folder, b->commit, a->commit);
}

// Returns what rows of a part are marked with: times of different devices cannot be compared, but
// pictures and errors can.
static const char *mark_of(const bench_results *all, const bench_results *part, arena *memory) {
    bool same = strcmp(all->device, part->device) == 0 && strcmp(all->driver, part->driver) == 0;
    return same ? NULL : arena_format(memory, "%s (%s)", part->device, part->driver);
}

static bool add_part(bench_results *all, bench_results *part, const char *from, const char *to) {
    const char *mark = mark_of(all, part, &part->memory);
    for (size_t i = 0; i < part->row_count; i++) {
        bench_row *row = &part->rows[i];
        if (mark && !(row->device && row->device[0])) row->device = mark;
        if (bench_find(all, row->index))
            return err_set("%s: row %zu (%s) was measured by another part, too", from, row->index,
                           row->label);
        if (!copy_thumbnail(row, from, to)) return false;
        bench_add(all, row);
    }
    return true;
}

bool bench_merge(const char *const *folders, size_t count, const char *folder, bench_results *out) {
    if (count < 1) return err_set("no folder with results to merge is named");
    if (!bench_read(folders[0], out)) return false;
    for (size_t i = 0; i < out->row_count; i++)
        if (!copy_thumbnail(&out->rows[i], folders[0], folder)) return false;
    for (size_t i = 1; i < count; i++) {
        bench_results part;
        if (!bench_read(folders[i], &part)) return false;
        bool done = is_same(out, &part, folders[i]) && add_part(out, &part, folders[i], folder);
        bench_results_free(&part);
        if (!done) return false;
    }
    return bench_write(out, folder);
}
