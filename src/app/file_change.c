#include "app/file_change.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 64 << 20 };

typedef struct content {
    void *data; // NULL: there is no file
    size_t size;
} content;

struct file_change {
    char root[PATH_CAP], path[PATH_CAP];
    content before, after;
};

static bool read_content(const file_change *c, content *out) {
    *out = (content){.data = NULL};
    return !file_exists(c->path) ||
           file_read_inside(c->root, c->path, MOST, &out->data, &out->size);
}

static bool is_same(const content *a, const content *b) {
    return a->size == b->size && !a->data == !b->data &&
           (!a->data || memcmp(a->data, b->data, a->size) == 0);
}

static bool remove_file(const file_change *c) {
    int folder = file_open_folder_inside(c->root, c->path);
    if (folder < 0) return false;
    bool done =
        unlinkat(folder, path_name(c->path), 0) == 0 || err_set("%s: %s", c->path, strerror(errno));
    close(folder);
    return done;
}

file_change *file_change_begin(const char *root, const char *path) {
    file_change *c = mem_alloc(sizeof *c);
    strcpy(c->root, root);
    if (path_join(c->path, root, path) && read_content(c, &c->before)) return c;
    file_change_free(c);
    return NULL;
}

bool file_change_end(file_change *c) {
    return read_content(c, &c->after);
}

bool file_change_apply(const file_change *c, bool back) {
    const content *from = back ? &c->after : &c->before, *to = back ? &c->before : &c->after;
    content now;
    if (!read_content(c, &now)) return false;
    bool same = is_same(&now, from);
    mem_free(now.data);
    if (!same) return err_set("%s has changed meanwhile; it stays as it is", c->path);
    return to->data ? file_write_inside(c->root, c->path, to->data, to->size) : remove_file(c);
}

void file_change_free(file_change *c) {
    if (!c) return;
    mem_free(c->before.data);
    mem_free(c->after.data);
    mem_free(c);
}
