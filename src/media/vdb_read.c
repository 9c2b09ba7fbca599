// OpenVDB by the reader: the data of its jobs and of their results, which are not trusted.
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include "base/time_limit.h"
#include "media/vdb_wire.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { GRIDS_MAX = 4096, AT_ONCE = 64 }; // AT_ONCE: files of one job

static const uint64_t COORD_MAX = 1 << 24;

// The files of a job, which are opened one after another when it asks for them.
typedef struct task {
    const char *root;
    const char *const *paths;
    size_t count;
    const char *asked;  // the last one
    char message[1024]; // why it could not be opened, or ""
} task;

static int task_give_file(void *user, const char *name, size_t *size) {
    task *t = user;
    for (size_t i = 0; i < t->count; i++) {
        if (strcmp(t->paths[i], name) != 0) continue;
        t->asked = t->paths[i];
        int file = file_open_inside(t->root, t->asked, VDB_FILE_BYTES_MAX, size);
        str_copy(t->message, sizeof t->message, file < 0 ? err_get() : "");
        return file;
    }
    return -1;
}

// The memory that a decoder needs besides its result (for the file and its tree) is not known
// before, so the limit is the most that can be valid.
static isolate_limits limits_of(uint64_t result) {
    const uint64_t beside = (uint64_t)1 << 30, message = 1 << 20;
    return (isolate_limits){.processor_ms = 120000,
                            .memory = budget_get_limit(budget_host()) + result + beside,
                            .result = result + message};
}

static bool task_run(task *t, isolate_job job, isolate_result *out) {
    job.open = task_give_file;
    job.user = t;
    job.name = t->count == 1 ? t->paths[0] : NULL;
    if (isolate_run(&job, out)) return true;
    if (t->message[0]) return err_set("%s", t->message);
    if (!job.name && t->asked && !strstr(err_get(), t->asked)) err_prefix("%s: ", t->asked);
    return false;
}

static void add_bytes(strbuf *out, const void *data, size_t size) {
    strbuf_append(out, data, size);
}

static bool nonsense(const char *path) {
    return err_set("%s: damaged: its reader returned nonsense", path);
}

// ---- what files say of themselves ---------------------------------------------------------------

typedef struct cursor {
    const char *at;
    size_t left;
} cursor;

static const void *take_bytes(cursor *c, size_t size) {
    const char *p = c->at;
    if (size > c->left) return NULL;
    c->at += size;
    c->left -= size;
    return p;
}

static const char *take_text(cursor *c, size_t size, arena *memory) {
    const char *text = take_bytes(c, size);
    return text && size > 0 && text[size - 1] == '\0' ? arena_string(memory, text) : NULL;
}

static bool is_sound(const vdb_sent_grid *g) {
    bool empty = g->index_min[0] > g->index_max[0];
    for (int i = 0; i < 3 && !empty; i++)
        if (g->index_min[i] > g->index_max[i] || g->index_min[i] < -(int32_t)COORD_MAX ||
            g->index_max[i] > (int32_t)COORD_MAX)
            return false;
    return (g->components == 0 || g->components == 1 || g->components == 3) &&
           (uint32_t)g->grid_class <= VDB_STAGGERED;
}

static bool take_grid(cursor *c, arena *memory, vdb_grid_info *out) {
    vdb_sent_grid g;
    const void *sent = take_bytes(c, sizeof g);
    if (!sent) return false;
    memcpy(&g, sent, sizeof g);
    *out = (vdb_grid_info){.name = take_text(c, g.name, memory),
                           .type = take_text(c, g.type, memory),
                           .components = g.components,
                           .grid_class = (vdb_class)g.grid_class,
                           .active_voxels = g.active_voxels,
                           .box = g.box,
                           .saved_half = g.saved_half != 0,
                           .linear = g.linear != 0,
                           .axis_aligned = g.axis_aligned != 0,
                           .sheared = g.sheared != 0};
    memcpy(out->voxel_size, g.voxel_size, sizeof g.voxel_size);
    memcpy(out->background, g.background, sizeof g.background);
    memcpy(out->index_min, g.index_min, sizeof g.index_min);
    memcpy(out->index_max, g.index_max, sizeof g.index_max);
    return out->name && out->type && is_sound(&g);
}

static bool take_info(cursor *c, arena *memory, vdb_info *out) {
    vdb_sent_info sent;
    const void *p = take_bytes(c, sizeof sent);
    if (!p) return false;
    memcpy(&sent, p, sizeof sent);
    *out = (vdb_info){0};
    if (sent.count == VDB_NO_EXTENTS) return true;
    const char *metadata = take_text(c, sent.text, memory);
    if (!metadata || sent.count > GRIDS_MAX) return false;
    vdb_grid_info *grids = arena_alloc(memory, sent.count * sizeof *grids);
    *out = (vdb_info){grids, sent.count, metadata, sent.y_up != 0};
    for (uint32_t i = 0; i < sent.count; i++)
        if (!take_grid(c, memory, &grids[i])) return false;
    return true;
}

// Asks again about files that have too little metadata for "vdb heads".
static bool ask_some(task *t, const char *kind, arena *const *memory, vdb_info *out) {
    strbuf names = {0};
    isolate_result r;
    for (size_t i = 0; i < t->count; i++) add_bytes(&names, t->paths[i], strlen(t->paths[i]) + 1);
    const isolate_job job = {.kind = kind,
                             .bytes = names.text,
                             .size = names.length,
                             .limits = limits_of((uint64_t)256 << 20)};
    bool done = task_run(t, job, &r);
    strbuf_free(&names);
    if (!done) return false;
    cursor c = {r.data, r.size};
    for (size_t i = 0; done && i < t->count; i++)
        done = take_info(&c, memory[i], &out[i]) || nonsense(t->paths[i]);
    isolate_free(&r);
    return done;
}

static bool ask_all(const task *t, arena *const *memory, vdb_info *out) { // by OpenVDB
    task all = *t;
    if (!ask_some(&all, "vdb info", memory, out)) return false;
    for (size_t i = 0; i < t->count; i++)
        if (!out[i].metadata) return nonsense(t->paths[i]);
    return true;
}

static bool read_some(task *t, arena *const *memory, vdb_info *out) {
    if (!ask_some(t, "vdb heads", memory, out)) return false;
    for (size_t i = 0, end; i < t->count; i = end + 1) {
        for (end = i; end < t->count && !out[end].metadata;) end++;
        const task rest = {.root = t->root, .paths = t->paths + i, .count = end - i};
        if (rest.count > 0 && !ask_all(&rest, memory + i, out + i)) return false;
    }
    return true;
}

bool vdb_read_infos(const char *root, const char *const *paths, size_t count, arena *const *memory,
                    vdb_info *out) {
    for (size_t i = 0; i < count; i += AT_ONCE) {
        if (!time_limit_progress((double)i, (double)count)) return err_prefix("%s: ", paths[i]);
        task t = {.root = root, .paths = paths + i, .count = count - i};
        if (t.count > AT_ONCE) t.count = AT_ONCE;
        if (!read_some(&t, memory + i, out + i)) return false;
    }
    return true;
}

bool vdb_read_info(const char *path, arena *memory, vdb_info *out) {
    return ask_all(&(task){.paths = &path, .count = 1}, &memory, out);
}

// ---- one grid as numbers ------------------------------------------------------------------------

bool vdb_sample(const vdb_sample_desc *d, uint64_t *bad) {
    const uint64_t most = (uint64_t)1 << 31; // voxels
    uint64_t voxels = 1;
    if (bad) *bad = 0;
    for (int i = 0; i < 3; i++) {
        if (d->size[i] == 0 || voxels > most / d->size[i])
            return err_set("%s: cannot resample to %ux%ux%u voxels; 1 to 2^31 are accepted",
                           d->path, d->size[0], d->size[1], d->size[2]);
        voxels *= d->size[i];
    }
    vdb_sent_sample sent = {.box = d->box, .components = d->components, .level_set = d->level_set};
    memcpy(sent.size, d->size, sizeof sent.size);
    size_t size = (size_t)voxels * (size_t)d->components * sizeof *d->out;
    strbuf bytes = {0};
    add_bytes(&bytes, &sent, sizeof sent);
    add_bytes(&bytes, d->grid, strlen(d->grid) + 1);
    const isolate_job job = {.kind = "vdb sample",
                             .bytes = bytes.text,
                             .size = bytes.length,
                             .limits = limits_of(size + sizeof *bad)};
    isolate_result r;
    bool done = task_run(&(task){.root = d->root, .paths = &d->path, .count = 1}, job, &r);
    strbuf_free(&bytes);
    if (!done) return false;
    done = r.size == size + sizeof *bad || nonsense(d->path);
    if (done) memcpy(d->out, r.data, size);
    if (done && bad) memcpy(bad, (const char *)r.data + size, sizeof *bad);
    isolate_free(&r);
    return done;
}

// ---- frames -------------------------------------------------------------------------------------

static const char frame_kind[] = "vdb frame";

uint64_t vdb_brick_count(const texels_shape *s) {
    uint64_t count = 1;
    for (int i = 0; i < 3; i++) count *= (s->size[i] + VDB_BRICK - 1) / VDB_BRICK;
    return count;
}

static void frame_describe(const vdb_frame_desc *d, strbuf *out) {
    vdb_sent_frame sent = {.box = d->box,
                           .y_up = d->shape.y_up,
                           .sparse = d->sparse,
                           .count = (uint32_t)d->count,
                           .level_set = d->level_set,
                           .width = d->shape.width,
                           .max_bytes = d->max_bytes};
    memcpy(sent.size, d->shape.size, sizeof sent.size);
    add_bytes(out, &sent, sizeof sent);
    for (size_t i = 0; i < d->count; i++) {
        const vdb_source *s = &d->sources[i];
        vdb_sent_source one = {.components = s->components, .name = (uint32_t)strlen(s->grid) + 1};
        memcpy(one.channels, s->channels, sizeof one.channels);
        memcpy(one.gains, s->gains, sizeof one.gains);
        add_bytes(out, &one, sizeof one);
        add_bytes(out, s->grid, one.name);
    }
}

// Adds to the textures the head, the room for two bricks of each, and the rounding to pages.
static uint64_t most_bytes(const vdb_frame_desc *d) {
    uint64_t bytes = (uint64_t)1 << 17;
    for (int i = 0; i < TEXELS_IMAGES && texels_width(&d->shape, i) > 0; i++)
        bytes += d->sparse ? vdb_brick_count(&d->shape) * sizeof(uint32_t)
                           : texels_image_bytes(&d->shape, i);
    return d->sparse ? bytes + d->max_bytes : bytes;
}

static bool lies_inside(const isolate_result *r, uint64_t at, uint64_t size) {
    return at % sizeof(uint32_t) == 0 && at >= sizeof(vdb_frame_head) && at <= r->size &&
           size <= r->size - at;
}

static bool take_image(const vdb_frame_desc *d, const vdb_frame_head *head, int image,
                       vdb_frame *out) {
    char *bytes = out->memory.data;
    uint64_t count = vdb_brick_count(&d->shape), at = head->images[image].texels,
             size = texels_image_bytes(&d->shape, image);
    uint32_t bricks = head->images[image].bricks;
    if (d->sparse)
        size = (uint64_t)bricks * VDB_BLOCK * VDB_BLOCK * VDB_BLOCK * sizeof(uint16_t) *
               (uint64_t)texels_width(&d->shape, image);
    if (!lies_inside(&out->memory, at, size)) return false;
    out->images[image].texels = (uint16_t *)(void *)(bytes + at);
    if (!d->sparse) return true;
    at = head->images[image].index;
    if (bricks > VDB_MOST_BRICKS || !lies_inside(&out->memory, at, count * sizeof(uint32_t)))
        return false;
    const uint32_t *index = (const uint32_t *)(const void *)(bytes + at);
    out->images[image].index = (uint32_t *)(void *)(bytes + at);
    out->images[image].bricks = bricks;
    for (uint64_t i = 0; i < count; i++)
        if (index[i] > bricks) return false;
    return true;
}

static bool take_frame(const vdb_frame_desc *d, vdb_frame *out) {
    vdb_frame_head head;
    uint32_t size[3];
    if (out->memory.size < sizeof head) return false;
    memcpy(&head, out->memory.data, sizeof head);
    out->active = head.active;
    out->bad = head.bad;
    texels_size(&d->shape, size);
    bool empty = head.active.low[0] == UINT32_MAX;
    for (int i = 0; i < 3 && !empty; i++)
        if (head.active.low[i] >= head.active.high[i] || head.active.high[i] > size[i])
            return false;
    for (int i = 0; i < TEXELS_IMAGES && texels_width(&d->shape, i) > 0; i++)
        if (!take_image(d, &head, i, out)) return false;
    return true;
}

void vdb_warm_up(void) {
    isolate_warm_up(frame_kind);
}

bool vdb_read_frame(const vdb_frame_desc *d, vdb_frame *out) {
    strbuf bytes = {0};
    *out = (vdb_frame){0};
    frame_describe(d, &bytes);
    const isolate_job job = {.kind = frame_kind,
                             .bytes = bytes.text,
                             .size = bytes.length,
                             .limits = limits_of(most_bytes(d))};
    bool done =
        task_run(&(task){.root = d->root, .paths = &d->path, .count = 1}, job, &out->memory);
    strbuf_free(&bytes);
    if (!done) return false;
    if (take_frame(d, out)) return true;
    vdb_frame_free(out);
    return nonsense(d->path);
}

void vdb_frame_free(vdb_frame *f) {
    isolate_free(&f->memory);
    *f = (vdb_frame){0};
}

// ---- writing ------------------------------------------------------------------------------------

static bool put_padding(const isolate_call *to, size_t *at) {
    static const char zeros[16];
    size_t missing = vdb_padded(*at) - *at;
    *at += missing;
    return isolate_put(to, zeros, missing);
}

static bool put_bytes(const isolate_call *to, const void *data, size_t size, size_t *at) {
    *at += size;
    return isolate_put(to, data, size);
}

static bool put_all(const isolate_call *to, const vdb_write_grid *grids, size_t count,
                    const vdb_entry *metadata, size_t entries, size_t *at) {
    const vdb_sent_write sent = {(uint32_t)count, (uint32_t)entries};
    bool done =
        put_bytes(to, &sent, sizeof sent, at) && put_bytes(to, grids, count * sizeof *grids, at);
    for (size_t i = 0; done && i < count; i++) {
        const vdb_write_grid *g = &grids[i];
        const void *values = g->halves ? (const void *)g->halves : g->values;
        done = put_padding(to, at) && put_bytes(to, values, vdb_values_size(g), at) &&
               put_bytes(to, g->name, strlen(g->name) + 1, at);
    }
    for (size_t i = 0; done && i < entries; i++) {
        const vdb_entry *e = &metadata[i];
        const vdb_sent_entry one = {.key = (uint32_t)strlen(e->key) + 1,
                                    .text = e->text ? (uint32_t)strlen(e->text) + 1 : 0,
                                    .number = e->number};
        done = put_bytes(to, &one, sizeof one, at) && put_bytes(to, e->key, one.key, at) &&
               put_bytes(to, e->text, one.text, at);
    }
    return done;
}

bool vdb_write_with(const char *path, const vdb_write_grid *grids, size_t count,
                    const vdb_entry *metadata, size_t entries) {
    isolate_result r;
    size_t size = 0;
    const isolate_call input = {.out = memfd_create("roil-volume", MFD_CLOEXEC)};
    bool done = input.out >= 0 || err_set("no memory file for the reader: %s", strerror(errno));
    done = done && put_all(&input, grids, count, metadata, entries, &size);
    // A file has at most a float and a bit for each value, and some nodes.
    const isolate_job job = {.kind = "vdb write",
                             .name = path,
                             .file = input.out,
                             .size = size,
                             .limits = limits_of(4 * (uint64_t)size + ((uint64_t)64 << 20))};
    if (!done) err_prefix("%s: ", path);
    done = done && isolate_run(&job, &r);
    if (input.out >= 0) close(input.out);
    if (!done) return false;
    done = file_write(path, r.data, r.size);
    isolate_free(&r);
    return done;
}

bool vdb_write(const char *path, const vdb_write_grid *grids, size_t count) {
    return vdb_write_with(path, grids, count, NULL, 0);
}
