// OpenVDB in the reader: receives jobs, does them, and sends results.
#include "base/memory.h"
#include "media/vdb_wire.h"
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// Reads what the client sent, which is trusted. Files are not trusted: vdb_layout.c reads them.
typedef struct cursor {
    const char *at;
} cursor;

static void take_bytes(cursor *c, void *out, size_t size) {
    memcpy(out, c->at, size);
    c->at += size;
}

static const char *take_text(cursor *c, size_t size) { // its zero byte among them
    const char *text = c->at;
    c->at += size;
    return text;
}

typedef struct opened {
    void *bytes;
    vdb_file *file;
} opened;

static bool open_file(const isolate_call *call, const char *name, opened *out) {
    size_t size;
    *out = (opened){0};
    if (!call->ask(call, name, VDB_FILE_BYTES_MAX, &out->bytes, &size)) return false;
    out->file = vdb_file_open(name, out->bytes, size);
    if (!out->file) mem_free(out->bytes);
    return out->file != NULL;
}

static void close_file(opened *f) {
    vdb_file_close(f->file);
    mem_free(f->bytes);
}

// ---- what files say of themselves ---------------------------------------------------------------

bool vdb_info_work(const isolate_call *call) {
    cursor c = {call->bytes};
    const char *end = c.at + call->size;
    bool done = true;
    while (done && c.at < end) {
        const char *name = take_text(&c, strlen(c.at) + 1);
        opened f;
        arena memory = {0};
        vdb_info info;
        if (!open_file(call, name, &f)) return false;
        done = vdb_file_info(f.file, &memory, &info) && vdb_put_info(call, &info);
        arena_free(&memory);
        close_file(&f);
    }
    return done;
}

// ---- one grid as numbers ------------------------------------------------------------------------

bool vdb_sample_work(const isolate_call *call) {
    cursor c = {call->bytes};
    vdb_sent_sample sent;
    take_bytes(&c, &sent, sizeof sent);
    vdb_sample_desc desc = {.path = call->name,
                            .grid = c.at,
                            .box = sent.box,
                            .components = sent.components,
                            .level_set = (vdb_set)sent.level_set};
    memcpy(desc.size, sent.size, sizeof desc.size);
    size_t size = (size_t)sent.size[0] * sent.size[1] * sent.size[2] * (size_t)sent.components *
                  sizeof(float);
    opened f;
    uint64_t bad;
    if (!open_file(call, call->name, &f)) return false;
    desc.out = isolate_map(call, 0, size + sizeof bad);
    bool done = desc.out && vdb_file_sample(f.file, &desc, &bad);
    if (done) memcpy((char *)desc.out + size, &bad, sizeof bad);
    if (desc.out) munmap(desc.out, size + sizeof bad);
    close_file(&f);
    return done;
}

// ---- a frame ------------------------------------------------------------------------------------

void *vdb_build_open(vdb_build *b, size_t size, size_t *at) {
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    *at = (b->used + page - 1) / page * page;
    return isolate_map(b->call, *at, size);
}

bool vdb_build_close(vdb_build *b, void *data, size_t size, size_t at, size_t kept) {
    munmap(data, size);
    b->used = at + kept;
    return isolate_cut(b->call, b->used);
}

static bool pack_source(vdb_build *b, const vdb_source *from, float *values, int image,
                        uint16_t *texels) {
    const texels_shape *shape = &b->desc->shape;
    vdb_sample_desc desc = {.path = b->desc->path,
                            .grid = from->grid,
                            .box = b->desc->box,
                            .components = from->components,
                            .out = values,
                            .level_set = b->desc->level_set};
    uint64_t bad;
    if (from->channels[0] / 4 != image) return true;
    memcpy(desc.size, shape->size, sizeof desc.size);
    if (!vdb_file_sample(b->file, &desc, &bad)) return false;
    b->head.bad += bad;
    for (int c = 0; c < from->components; c++)
        texels_pack(shape, values + c, from->components, from->gains[c], texels, from->channels[c],
                    &b->head.active);
    return true;
}

static bool build_dense(vdb_build *b, float *values, int image) {
    size_t size = (size_t)texels_image_bytes(&b->desc->shape, image), at;
    uint16_t *texels = vdb_build_open(b, size, &at);
    bool done = texels != NULL;
    for (size_t i = 0; done && i < b->desc->count; i++)
        done = pack_source(b, &b->desc->sources[i], values, image, texels);
    if (texels) done = vdb_build_close(b, texels, size, at, size) && done;
    b->head.images[image].texels = at;
    return done;
}

static bool frame_build(vdb_build *b) {
    const texels_shape *s = &b->desc->shape;
    size_t voxels = (size_t)s->size[0] * s->size[1] * s->size[2], widest = 1;
    for (size_t i = 0; i < b->desc->count; i++)
        if (b->desc->sources[i].components == 3) widest = 3;
    float *values = b->desc->sparse ? NULL : mem_alloc(voxels * widest * sizeof *values);
    bool done = true;
    b->used = sizeof b->head;
    b->head.active = texels_nothing();
    for (int i = 0; done && texels_width(s, i) > 0; i++)
        done = b->desc->sparse ? vdb_build_bricks(b, i) : build_dense(b, values, i);
    mem_free(values);
    return done && isolate_put(b->call, &b->head, sizeof b->head);
}

bool vdb_frame_work(const isolate_call *call) {
    cursor c = {call->bytes};
    vdb_sent_frame sent;
    vdb_source sources[VDB_SOURCES];
    take_bytes(&c, &sent, sizeof sent);
    for (uint32_t i = 0; i < sent.count; i++) {
        vdb_sent_source one;
        take_bytes(&c, &one, sizeof one);
        sources[i] = (vdb_source){.components = one.components, .grid = take_text(&c, one.name)};
        memcpy(sources[i].channels, one.channels, sizeof one.channels);
        memcpy(sources[i].gains, one.gains, sizeof one.gains);
    }
    const vdb_frame_desc desc = {
        .path = call->name,
        .box = sent.box,
        .shape = {{sent.size[0], sent.size[1], sent.size[2]}, sent.y_up != 0, sent.width},
        .sparse = sent.sparse != 0,
        .max_bytes = sent.max_bytes,
        .sources = sources,
        .count = sent.count,
        .level_set = (vdb_set)sent.level_set};
    opened f;
    if (!open_file(call, call->name, &f)) return false;
    vdb_build b = {.call = call, .file = f.file, .desc = &desc};
    bool done = frame_build(&b);
    close_file(&f);
    return done;
}

// ---- writing ------------------------------------------------------------------------------------

// The values of a grid begin at multiples of 16 bytes.
static const void *take_padded(cursor *c, const char *begin, size_t size) {
    c->at = begin + vdb_padded((size_t)(c->at - begin));
    return take_text(c, size);
}

bool vdb_write_work(const isolate_call *call) {
    cursor c = {call->bytes};
    vdb_sent_write sent;
    void *data;
    size_t size;
    take_bytes(&c, &sent, sizeof sent);
    vdb_write_grid *grids = mem_alloc(sent.grids * sizeof *grids);
    vdb_entry *entries = mem_alloc(sent.entries * sizeof *entries);
    take_bytes(&c, grids, sent.grids * sizeof *grids);
    for (uint32_t i = 0; i < sent.grids; i++) {
        vdb_write_grid *g = &grids[i];
        const void *values = take_padded(&c, call->bytes, vdb_values_size(g));
        if (g->halves)
            g->halves = values;
        else
            g->values = values;
        g->name = take_text(&c, strlen(c.at) + 1);
    }
    for (uint32_t i = 0; i < sent.entries; i++) {
        vdb_sent_entry one;
        take_bytes(&c, &one, sizeof one);
        entries[i].key = take_text(&c, one.key);
        entries[i].text = one.text ? take_text(&c, one.text) : NULL;
        entries[i].number = one.number;
    }
    bool done = vdb_encode(call->name, grids, sent.grids, entries, sent.entries, &data, &size);
    mem_free(entries);
    mem_free(grids);
    if (!done) return false;
    done = isolate_put(call, data, size);
    mem_free(data);
    return done;
}

// ---- before all
// -----------------------------------------------------------------------------------

void vdb_get_ready(void) {
    enum { SIDE = 9 };
    float values[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) values[i] = (float)(i % 7);
    const vdb_write_grid grid = {.name = "x",
                                 .size = {SIDE, SIDE, SIDE},
                                 .values = values,
                                 .components = 1,
                                 .voxel_size = 1,
                                 .half = true};
    arena memory = {0};
    vdb_info info;
    void *data;
    size_t size;
    vdb_work_alone();
    if (!vdb_encode("x", &grid, 1, NULL, 0, &data, &size)) return;
    vdb_file *f = vdb_file_open("x", data, size);
    if (f && vdb_file_info(f, &memory, &info))
        vdb_file_sample(f,
                        &(vdb_sample_desc){.path = "x",
                                           .grid = "x",
                                           .box = info.grids[0].box,
                                           .size = {SIDE, SIDE, SIDE},
                                           .components = 1,
                                           .out = values},
                        NULL);
    vdb_file_close(f);
    arena_free(&memory);
    mem_free(data);
}
