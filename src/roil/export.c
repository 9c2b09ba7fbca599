// Exports an OpenVDB sequence as one raw file, for engines that read plain voxels. Every frame is
// resampled into the box that encloses all of them (Raseta, Lesar and Bohak 2025, section 3.2).
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "field/sequence.h"
#include "media/vdb.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

typedef struct voxel_type {
    const char *name;
    size_t size;
} voxel_type;

static const voxel_type types[] = {{"u8", 1}, {"u16", 2}, {"f16", 2}, {"f32", 4}};

static const voxel_type *find_type(const char *name) {
    for (size_t i = 0; i < COUNT_OF(types); i++)
        if (strcmp(types[i].name, name) == 0) return &types[i];
    err_set("type '%s'; accepted: u8, u16, f16, f32", name);
    return NULL;
}

// Encodes values as the type says. Integers cover the range 0 to `scale`; halves and floats are
// stored as they are.
static void encode_voxels(const voxel_type *type, const float *values, size_t count, float scale,
                          unsigned char *out) {
    for (size_t i = 0; i < count; i++) {
        float part = clampf(values[i] / scale, 0, 1);
        uint16_t word =
            type->name[0] == 'f' ? half_from_float(values[i]) : (uint16_t)lrintf(part * 65535);
        if (type->size == 1)
            out[i] = (unsigned char)lrintf(part * 255);
        else if (type->size == 2)
            memcpy(out + i * 2, &word, 2);
        else
            memcpy(out + i * 4, &values[i], 4);
    }
}

typedef struct exporter {
    const sequence *sequence;
    const field_grid *grid; // for its box and size
    const char *const *files;
    size_t file_count, voxels;
    int64_t frames; // of the timeline
    const char *name;
    float *values;
    const roil_export *desc;
    size_t read; // frames, each twice in the end
} exporter;

// Samples one frame. A file without the grid gives a frame of zeros and leaves `*present` as it is.
static bool sample_frame(exporter *x, size_t frame, bool *present) {
    const roil_export *d = x->desc;
    if (d->progress && !d->progress(d->user, (double)x->read++, 2.0 * (double)x->file_count))
        return err_set("stopped after %zu of %zu frames", frame, x->file_count);
    memset(x->values, 0, x->voxels * sizeof *x->values);
    if (!sequence_has_numbers(x->sequence, frame, x->name)) return true;
    *present = true;
    vdb_sample_desc desc = {.path = x->files[frame],
                            .grid = x->name,
                            .box = x->grid->box,
                            .components = 1,
                            .out = x->values};
    memcpy(desc.size, x->grid->size, sizeof desc.size);
    return vdb_sample(&desc, NULL);
}

// Finds the maximum over all frames, so that integers use their whole range.
static bool find_scale(exporter *x, float *scale) {
    bool present = false;
    *scale = 0;
    for (size_t frame = 0; frame < x->file_count; frame++) {
        if (!sample_frame(x, frame, &present)) return false;
        for (size_t i = 0; i < x->voxels; i++) *scale = fmaxf(*scale, x->values[i]);
    }
    if (!present) return err_set("no file has a grid '%s' of numbers", x->name);
    if (!(*scale > 0)) *scale = 1;
    return true;
}

// Writes all frames. A frame that has no file of its own is written as the sequence shows it.
static bool write_frames(exporter *x, const voxel_type *type, float scale, const sequence *s,
                         file_draft *out) {
    unsigned char *bytes = mem_alloc(x->voxels * type->size);
    bool done = true, present;
    size_t sampled = SIZE_MAX;
    for (int64_t frame = 0; done && frame < x->frames; frame++) {
        size_t file = sequence_file_at(s, frame);
        if (file != sampled) {
            done = sample_frame(x, file, &present);
            if (!done) break;
            encode_voxels(type, x->values, x->voxels, scale, bytes);
            sampled = file;
        }
        file_draft_add(out, bytes, x->voxels * type->size);
    }
    mem_free(bytes);
    return done;
}

static bool write_file(exporter *x, const voxel_type *type, float scale, const sequence *s,
                       const char *file) {
    const int64_t most = 100000; // that `raw` reads
    if (x->frames > most)
        return err_set("%s: %lld frames from the least number in the names to the greatest; at "
                       "most %lld are accepted",
                       file, (long long)x->frames, (long long)most);
    file_draft draft;
    if (!file_make_parent_folders(file) || !file_draft_begin(&draft, file)) return false;
    if (write_frames(x, type, scale, s, &draft)) return file_draft_end(&draft);
    file_draft_drop(&draft);
    return err_prefix("%s: ", file);
}

// Returns the file's name as an effect in the current folder can give it; a file outside of it by
// its last component.
static const char *named_by_effect(const char *file) {
    bool below = file[0] != '/' && strncmp(file, "../", 3) != 0 && !strstr(file, "/../");
    return below ? file : path_name(file);
}

static char *describe_export(const exporter *x, const voxel_type *type, float scale,
                             const char *file) {
    const field_grid *g = x->grid;
    strbuf text = {0};
    const box3 *b = &g->box;
    strbuf_add(&text, "%s: %lld frames of %u x %u x %u voxels, %s\n", file, (long long)x->frames,
               g->size[0], g->size[1], g->size[2], type->name);
    strbuf_add(&text,
               "raw { \"%s\", type = \"%s\", size = {%u, %u, %u}, value_scale = %g, channel = "
               "\"%s\", box = { min = {%g, %g, %g}, max = {%g, %g, %g} }%s }\n",
               named_by_effect(file), type->name, g->size[0], g->size[1], g->size[2],
               type->name[0] == 'u' ? (double)scale : 1.0, x->name, (double)b->min.x,
               (double)b->min.y, (double)b->min.z, (double)b->max.x, (double)b->max.y,
               (double)b->max.z, sequence_says_y_up(x->sequence) ? ", y_up = true" : "");
    return text.text;
}

char *roil_export_raw(const roil_export *desc) {
    mem_enter();
    const voxel_type *type = find_type(desc->type ? desc->type : "u8");
    arena memory = {0};
    // Every voxel is written: the limits are those of a dense frame.
    const sequence_desc dense = {.pattern = desc->pattern, .storage = SEQUENCE_DENSE};
    sequence *s = type ? sequence_create(&memory, &dense) : NULL;
    char *text = NULL;
    if (s) {
        field_grid *grid = sequence_grid(s);
        exporter x = {.sequence = s,
                      .grid = grid,
                      .name = desc->grid ? desc->grid : "density",
                      .frames = sequence_frame_count(s),
                      .desc = desc};
        x.file_count = sequence_files(s, &x.files);
        x.voxels = (size_t)grid->size[0] * grid->size[1] * grid->size[2];
        budget_part *part = budget_take(
            budget_host(), (uint64_t)x.voxels * (sizeof *x.values + type->size), "voxels to write");
        if (part) x.values = mem_alloc(x.voxels * sizeof *x.values);
        float scale;
        if (part && find_scale(&x, &scale) && write_file(&x, type, scale, s, desc->file))
            text = describe_export(&x, type, scale, desc->file);
        mem_free(x.values);
        budget_give(part);
        grid->destroy(grid, NULL);
    }
    arena_free(&memory);
    return roil_leave_text(text);
}
