// Volumes of an effect as OpenVDB files. After a frame the baked images are read back as halves;
// another thread has the file written.
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "media/vdb.h"
#include "roil/roil_impl.h"
#include <string.h>

enum { WAITING = 2 }; // frames that wait for their file

struct roil_volume {
    roil_effect *owner;
    effect_volume content;
    float tolerance;
    double first, last;     // frames
    const char *options[9]; // that `roil export vdb` takes for the same
    arena memory;
    jobs *files;
};

typedef struct volume_file { // all that it needs, away from the effect and its device
    char path[PATH_CAP], effect[256], *recipe;
    vdb_write_grid grids[EFFECT_VOLUME_FIELDS];
    budget_part *parts[EFFECT_VOLUME_FIELDS];
    uint16_t *halves[EFFECT_VOLUME_FIELDS];
    char names[EFFECT_VOLUME_FIELDS][64];
    size_t count;
    double frame, time, fps;
} volume_file;

static box3 box_of(const float box[2][3]) {
    return (box3){{box[0][0], box[0][1], box[0][2]}, {box[1][0], box[1][1], box[1][2]}};
}

static void volume_free(roil_volume *v) {
    arena_free(&v->memory);
    mem_free(v);
}

static void note_options(roil_volume *v, const roil_volume_desc *d) {
    size_t count = 0;
    const float(*box)[3] = d->box;
    const char *const given[] = {
        d->source ? arena_format(&v->memory, "--source=%s", d->source) : NULL,
        d->fields ? arena_format(&v->memory, "--fields=%s", d->fields) : NULL,
        d->size ? arena_format(&v->memory, "--size=%u", d->size) : NULL,
        memcmp(box[0], box[1], sizeof *box) != 0
            ? arena_format(&v->memory, "--box=%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", (double)box[0][0],
                           (double)box[0][1], (double)box[0][2], (double)box[1][0],
                           (double)box[1][1], (double)box[1][2])
            : NULL,
        d->tolerance > 0 ? arena_format(&v->memory, "--tolerance=%.9g", (double)d->tolerance)
                         : NULL,
    };
    for (size_t i = 0; i < COUNT_OF(given); i++)
        if (given[i]) v->options[count++] = given[i];
}

static roil_volume *create_volume(roil_effect *e, const roil_volume_desc *desc) {
    roil_volume *v = mem_alloc(sizeof *v);
    v->owner = e;
    v->tolerance = desc->tolerance;
    v->first = desc->first;
    v->last = desc->last;
    note_options(v, desc);
    const effect_volume_desc wanted = {.source = desc->source,
                                       .fields = desc->fields,
                                       .size = desc->size,
                                       .box = box_of(desc->box),
                                       .first = desc->first,
                                       .last = desc->last};
    bool done = effect_add_volume(e->effect, &wanted, &v->content);
    for (size_t i = 0; done && i < v->content.count; i++)
        done =
            roil_keep(e, graph_get_desc(effect_graph(e->effect), v->content.fields[i].image)->name);
    if (!done) {
        volume_free(v);
        return NULL;
    }
    if (desc->alone) effect_skip_pictures(e->effect);
    v->files = jobs_create(1, WAITING);
    if (v->files) return v;
    volume_free(v);
    return NULL;
}

roil_volume *roil_volume_create(roil_effect *e, const roil_volume_desc *desc) {
    RETURN_MADE(roil_volume, create_volume(e, desc), roil_volume_finish(made));
}

roil_volume_info roil_volume_get_info(const roil_volume *v) {
    roil_volume_info info = {.voxel_size = v->content.voxel};
    memcpy(info.size, v->content.size, sizeof info.size);
    for (size_t i = 0, at = 0; i < v->content.count && at < sizeof info.fields; i++)
        at += (size_t)snprintf(info.fields + at, sizeof info.fields - at, "%s%s", i ? ", " : "",
                               v->content.fields[i].name);
    return info;
}

// ---- files ------------------------------------------------------------------------------------

static bool write_file(void *user) {
    const volume_file *f = user;
    const vdb_entry metadata[] = {
        {.key = "effect", .text = f->effect}, {.key = "up", .text = "z"},
        {.key = "frame", .number = f->frame}, {.key = "time", .number = f->time},
        {.key = "fps", .number = f->fps},     {.key = "roil:recipe", .text = f->recipe},
    };
    return file_make_parent_folders(f->path) &&
           vdb_write_with(f->path, f->grids, f->count, metadata,
                          COUNT_OF(metadata) - (f->recipe ? 0 : 1));
}

static void free_file(void *user) {
    volume_file *f = user;
    for (size_t i = 0; i < f->count; i++) {
        mem_free(f->halves[i]);
        budget_give(f->parts[i]);
    }
    mem_free(f->recipe);
    mem_free(f);
}

static bool read_field(const roil_volume *v, size_t index, volume_file *f) {
    const effect_volume *c = &v->content;
    const effect_volume_field *from = &c->fields[index];
    gpu_image *image = graph_get_image(effect_graph(v->owner->effect), from->image);
    size_t voxels = (size_t)c->size[0] * c->size[1] * c->size[2];
    int stride = from->components == 1 ? 1 : 4;
    size_t size = voxels * (size_t)stride * sizeof(uint16_t);
    // Beside the halves: on their way to the reader, in it, and as floats in the tree that it
    // writes.
    f->parts[index] =
        budget_take(budget_host(), 5 * (uint64_t)size, "volumes read back and written");
    if (!f->parts[index]) return err_prefix("%s: ", from->name);
    f->halves[index] = mem_alloc(size);
    f->count = index + 1;
    str_copy(f->names[index], sizeof f->names[index], from->name);
    float half = c->voxel / 2;
    f->grids[index] = (vdb_write_grid){
        .name = f->names[index],
        .size = {c->size[0], c->size[1], c->size[2]},
        .halves = f->halves[index],
        .stride = stride,
        .components = from->components,
        .voxel_size = c->voxel,
        .origin = {c->box.min.x + half, c->box.min.y + half, c->box.min.z + half},
        .half = true,
        .tolerance = v->tolerance,
        .grid_class = VDB_FOG,
        .turns = strcmp(from->name, "velocity") == 0,
    };
    return gpu_image_read(v->owner->owner->device, image, f->halves[index], size);
}

bool roil_volume_save(roil_volume *v, const char *file) {
    mem_enter();
    roil_effect *e = v->owner;
    if (!e->frame) return mem_leave(err_set("there is no volume yet: render a frame first"));
    if (strcmp(path_extension(file), "vdb") != 0)
        return mem_leave(err_set("output '%s'; accepted: .vdb", file));
    volume_file *f = mem_alloc(sizeof *f);
    const effect_facts *facts = effect_get_facts(e->effect);
    f->fps = facts->fps;
    f->frame = e->shown;
    f->time = (e->shown - facts->first) / f->fps;
    str_copy(f->effect, sizeof f->effect, facts->name);
    f->recipe = roil_describe(e, &(roil_making){.kind = "volume",
                                                .first = v->first,
                                                .last = v->last,
                                                .step = 1,
                                                .options = v->options});
    bool done = str_copy(f->path, sizeof f->path, file) || path_too_long(file);
    for (size_t i = 0; done && i < v->content.count; i++) done = read_field(v, i, f);
    if (done) return mem_leave(jobs_add(v->files, write_file, free_file, f));
    free_file(f);
    return mem_leave(false);
}

bool roil_volume_finish(roil_volume *v) {
    mem_enter();
    if (!v) return mem_leave(true);
    bool done = jobs_finish(v->files);
    volume_free(v);
    return mem_leave(done);
}
