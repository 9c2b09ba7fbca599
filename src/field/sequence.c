// Sequences: which files, in which box, and what of them is on the device.
//
// All frames share one box: the union of the active voxels of every readable grid of every file,
// moved outward to the lattice of the first grid that is not empty, so that frames on this lattice
// are copied voxel by voxel, plus one voxel of background on each side, into which linear filtering
// fades. Raw files have the box that their description gives them.
#include "field/sequence.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "field/sequence_parts.h"
#include <math.h>
#include <string.h>

static const char *const loop_names[] = {"clip", "extend", "repeat", "ping_pong"};

const char *sequence_loop_name(sequence_loop loop) {
    return (unsigned)loop < COUNT_OF(loop_names) ? loop_names[loop] : "?";
}

// ---- files and box ----------------------------------------------------------------------------

static bool list_files(sequence_data *s) {
    const char *pattern = s->desc.pattern;
    file_list list = {0};
    if (!file_glob(pattern, &list)) return false;
    bool ok = list.count > 0 && list.count <= SEQUENCE_MAX_FRAMES;
    if (list.count == 0)
        err_set("%s: no file has such a name%s", pattern,
                strchr(pattern, '%') ? "; '*' stands for the number of a frame" : "");
    else if (!ok)
        err_set("%s: %zu files; at most %d are accepted", pattern, list.count, SEQUENCE_MAX_FRAMES);
    const char **files = arena_alloc(&s->memory, (list.count + 1) * sizeof *files);
    for (size_t i = 0; i < list.count; i++) files[i] = arena_string(&s->memory, list.paths[i]);
    if (ok && s->desc.root) ok = path_require_all_inside(s->desc.root, files, list.count);
    s->files = files;
    s->file_count = list.count;
    file_list_free(&list);
    if (ok && !s->raw) sequence_number_files(s);
    return ok;
}

static bool usable(const vdb_grid_info *grid) {
    return grid->components > 0 && grid->linear && grid->index_min[0] <= grid->index_max[0];
}

typedef struct lattice { // of voxel borders, along one axis
    double origin, voxel;
} lattice;

// ---- storage ----------------------------------------------------------------------------------

// Voxels of the fullest grid of a frame.
static uint64_t active_of(const vdb_info *info) {
    uint64_t most = 0;
    for (size_t k = 0; k < info->count; k++) {
        const vdb_grid_info *grid = &info->grids[k];
        uint64_t count = grid->active_voxels;
        if (!usable(grid)) continue;
        if (count == 0) { // the file does not say: all of its box
            count = 1;
            for (int a = 0; a < 3; a++)
                count *= (uint64_t)((int64_t)grid->index_max[a] - grid->index_min[a] + 1);
        }
        if (count > most) most = count;
    }
    return most;
}

float sequence_growth(const sequence_data *s, uint32_t frame) {
    uint64_t active = s->sparse ? active_of(&s->infos[frame]) : 0;
    return active > 0 ? (float)s->most_active / (float)active : 1;
}

// Small grids are not worth a second fetch a sample. Of large ones, bricks with their borders take
// up to about three times the bytes of the active voxels; half the dense size must be saved.
static bool choose_sparse(sequence_data *s, uint64_t voxels) {
    const uint64_t small = (uint64_t)4 << 20, most_bricks = 1 << 24;
    uint64_t active = 0, bricks = sequence_brick_count(s);
    for (size_t i = 0; i < s->file_count; i++) {
        uint64_t here = active_of(&s->infos[i]);
        if (here > active) active = here;
    }
    s->most_active = active;
    double across = cbrt((double)active / (VDB_BRICK * VDB_BRICK * VDB_BRICK));
    s->atlas_across = (uint32_t)clampf(ceilf((float)across), 1, 64);
    if (s->desc.storage != SEQUENCE_AUTO) return s->desc.storage == SEQUENCE_SPARSE;
    return voxels > small && bricks <= most_bricks && 6 * active + 2 * bricks < voxels;
}

static bool snap(sequence_data *s, const box3 *all, const vdb_grid_info *first) {
    const float low[3] = {all->min.x, all->min.y, all->min.z};
    const float high[3] = {all->max.x, all->max.y, all->max.z};
    const float base[3] = {first->box.min.x, first->box.min.y, first->box.min.z};
    float min[3], max[3];
    uint64_t voxels = 1;
    for (int i = 0; i < 3; i++) {
        lattice l = {(double)base[i], (double)first->voxel_size[i]};
        const double slack = 1e-3; // of a voxel: rounding of the boxes
        double from = floor(((double)low[i] - l.origin) / l.voxel + slack) - 1;
        double to = ceil(((double)high[i] - l.origin) / l.voxel - slack) + 1;
        if (!(to - from >= 1 && to - from <= 1e6))
            return err_set("%s: the sequence spans %g m in voxels of %g m", s->desc.pattern,
                           (double)high[i] - (double)low[i], l.voxel);
        s->file_size[i] = (uint32_t)(to - from);
        voxels *= s->file_size[i]; // at most 1e18
        min[i] = (float)(l.origin + from * l.voxel);
        max[i] = (float)(l.origin + to * l.voxel);
    }
    s->file_box = (box3){{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
    s->sparse = choose_sparse(s, voxels);
    uint64_t least =
        s->sparse ? sequence_brick_count(s) * sizeof(uint32_t) : voxels * sizeof(uint16_t);
    if (least > s->desc.max_frame_bytes)
        return err_set("%s: the box of the whole sequence has %u x %u x %u voxels, more than the "
                       "limit of %llu bytes a frame",
                       s->desc.pattern, s->file_size[0], s->file_size[1], s->file_size[2],
                       (unsigned long long)s->desc.max_frame_bytes);
    return true;
}

// What files say of themselves, kept between loads of the same effect: those that are not yet.
static bool read_missing(sequence_data *s, vdb_info *infos) {
    size_t count = 0;
    const char **paths = mem_alloc(s->file_count * sizeof *paths);
    arena **memory = mem_alloc(s->file_count * sizeof *memory);
    arena *made = mem_alloc(s->file_count * sizeof *made);
    vdb_info *read = mem_alloc(s->file_count * sizeof *read);
    for (size_t i = 0; i < s->file_count; i++) {
        if (s->held[i]) continue;
        memory[count] = s->desc.contents ? &made[count] : &s->memory;
        paths[count++] = s->files[i];
    }
    int64_t begin = file_clock_ns();
    bool done = vdb_read_infos(s->desc.root, paths, count, memory, read);
    for (size_t i = 0, k = 0; done && k < count; i++) {
        if (s->held[i]) continue;
        infos[i] = read[k];
        if (s->desc.contents) {
            vdb_info *kept = arena_copy(&made[k], &read[k], sizeof *kept);
            s->held[i] =
                content_cache_put(s->desc.contents, paths[k], kept, made[k], &paths[k], 1, begin);
        }
        k++;
    }
    for (size_t i = 0; !done && i < count; i++) arena_free(&made[i]);
    mem_free(read);
    mem_free(made);
    mem_free(memory);
    mem_free(paths);
    return done;
}

static bool read_infos(sequence_data *s, vdb_info *infos) {
    s->held_count = s->desc.contents ? s->file_count : 0;
    for (size_t i = 0; i < s->held_count; i++) {
        s->held[i] = content_cache_take(s->desc.contents, s->files[i]);
        if (s->held[i]) infos[i] = *(const vdb_info *)s->held[i]->data;
    }
    return read_missing(s, infos);
}

static bool refuse_all(const sequence_data *s) {
    strbuf names = {0};
    for (size_t i = 0; i < s->file_count && names.length == 0; i++)
        sequence_list_grids(&s->infos[i], &names);
    err_set("%s: no grid that can be read in %s%s%s", s->desc.pattern,
            s->file_count > 1 ? "these files" : "this file", names.length > 0 ? ": " : "",
            strbuf_text(&names));
    strbuf_free(&names);
    return false;
}

static bool open_vdb(sequence_data *s) {
    vdb_info *infos = arena_alloc(&s->memory, s->file_count * sizeof *infos);
    s->infos = infos;
    s->held = arena_alloc(&s->memory, s->file_count * sizeof *s->held);
    const vdb_grid_info *first = NULL;
    box3 all = box3_empty();
    size_t readable = 0;
    if (!read_infos(s, infos)) return false;
    for (size_t i = 0; i < s->file_count; i++) {
        for (size_t k = 0; k < infos[i].count; k++) {
            const vdb_grid_info *grid = &infos[i].grids[k];
            if (grid->components > 0 && grid->linear) readable++;
            if (!usable(grid)) continue;
            if (!first) first = grid;
            all = box3_union(all, grid->box);
        }
    }
    s->frame_count = (uint32_t)s->file_count;
    if (s->desc.up_by_creator) s->desc.y_up = infos[0].y_up;
    if (readable == 0) return refuse_all(s);
    if (!first) { // nothing but empty grids: a voxel of nothing
        s->file_box = (box3){{0, 0, 0}, {1, 1, 1}};
        for (int i = 0; i < 3; i++) s->file_size[i] = 1;
        return true;
    }
    return snap(s, &all, first);
}

static void place(sequence_data *s) { // the grid's box and size, from the file's
    box3 b = s->file_box;
    const uint32_t *size = s->file_size;
    float k = s->desc.scale;
    float3 o = s->desc.offset;
    memcpy(s->size, size, sizeof s->size);
    if (s->desc.y_up) {
        s->size[1] = size[2];
        s->size[2] = size[1];
        b = (box3){{b.min.x, -b.max.z, b.min.y}, {b.max.x, -b.min.z, b.max.y}};
    }
    s->box = (box3){{b.min.x * k + o.x, b.min.y * k + o.y, b.min.z * k + o.z},
                    {b.max.x * k + o.x, b.max.y * k + o.y, b.max.z * k + o.z}};
}

// ---- playback ---------------------------------------------------------------------------------

// Frames that are decoded or about to be: so many that threads which are done with small ones do
// not wait for the large, as far as memory allows.
static uint32_t count_ahead(const sequence_data *s) {
    const uint64_t most = (uint64_t)2 << 30;
    uint32_t threads = s->cache.jobs.threads, many = 2 * threads + 2;
    uint64_t frame = s->cache.counts.largest_bytes;
    if (frame == 0 || many > most / frame) many = threads + 2;
    return many < SEQUENCE_MAX_JOBS ? many : SEQUENCE_MAX_JOBS;
}

// What is late first, then what comes next.
static void decode_ahead(sequence_data *s, double position, const uint32_t late[2], size_t count) {
    uint32_t frames[SEQUENCE_MAX_JOBS], most = count_ahead(s);
    double step = position - s->last_position;
    s->last_position = position;
    // After a jump: playback at the rate of the files is as good a guess as any. Less than a frame
    // at a time shows all of them.
    if (!(fabs(step) > 1e-3 && fabs(step) < 8)) step = 1;
    if (fabs(step) < 1) step = copysign(1, step);
    memcpy(frames, late, count * sizeof *late);
    for (uint32_t i = 1; count < most && i <= most; i++) {
        uint32_t around[2];
        float blend;
        if (!sequence_frames_at(s, position + step * i, around, &blend)) break;
        uint32_t frame = around[step > 0];
        if (count == 0 || frames[count - 1] != frame) frames[count++] = frame;
    }
    sequence_cache_ahead(s, frames, count);
}

static void put(sequence *s, const sequence_slot *now, const sequence_slot *next, float blend) {
    field_grid_state *state = &s->grid.state;
    memcpy(state->images[0], now->images, sizeof now->images);
    memcpy(state->images[1], next->images, sizeof next->images);
    memcpy(state->index[0], now->index, sizeof now->index);
    memcpy(state->index[1], next->index, sizeof next->index);
    state->active = box3_union(now->active, next->active);
    state->blend = now == next ? 0 : blend;
    uint64_t content = 1 + (now->frame | (uint64_t)next->frame << 32);
    s->data->cache.counts.shown += content != state->content;
    state->content = content;
}

// Shows the frames of now, as far as they are there. Returns how many are late; SIZE_MAX: an error.
static size_t show_punctual(sequence *s, gpu *g, const uint32_t frames[2], float blend,
                            uint32_t late[2]) {
    sequence_slot *found[2];
    size_t count = 0, needed = blend > 0 ? 2 : 1;
    for (size_t i = 0; i < needed; i++) {
        found[i] = sequence_cache_nearest(s->data, frames[i]);
        if (found[i] && found[i]->frame == frames[i]) continue;
        if (sequence_cache_failed(s->data, g, frames[i])) return SIZE_MAX;
        late[count++] = frames[i];
    }
    if (!found[0]) { // the very first
        found[0] = found[1] = sequence_cache_get(s->data, g, frames[0]);
        if (!found[0]) return SIZE_MAX;
    }
    put(s, found[0], found[needed - 1], blend);
    s->data->cache.counts.late += count > 0;
    return count;
}

static bool show(sequence *s, gpu *g, double position, const uint32_t frames[2], float blend) {
    uint32_t late[2] = {0};
    size_t count = 0;
    sequence_cache_turn(s->data);
    if (s->grid.never_waits) {
        sequence_cache_pump(s->data, g);
        count = show_punctual(s, g, frames, blend, late);
        if (count == SIZE_MAX) return false;
    } else {
        sequence_slot *now = sequence_cache_get(s->data, g, frames[0]);
        if (!now) return false;
        sequence_slot *next = blend > 0 ? sequence_cache_get(s->data, g, frames[1]) : now;
        if (!next) return false;
        put(s, now, next, blend);
    }
    s->data->cache.counts.waiting = count > 0;
    s->data->cache.counts.threads = s->data->cache.jobs.threads;
    decode_ahead(s->data, position, late, count);
    if (!s->grid.never_waits) sequence_cache_pump(s->data, g);
    return true;
}

static bool update(field_grid *grid, gpu *g, double time) {
    sequence *s = (sequence *)grid;
    uint32_t frames[2];
    float blend;
    double position = sequence_position(s->data, time);
    bool inside = sequence_frames_at(s->data, position, frames, &blend);
    s->sealed = true;
    if (!g) {
        grid->state.active = grid->box;
        grid->state.blend = blend;
    } else if (!show(s, g, position, frames, blend)) {
        return false;
    }
    if (!inside) grid->state.active = box3_empty();
    return true;
}

// One frame, or the two that are mixed, and the memory that they are copied from one by one.
static field_needs needs(const field_grid *grid) {
    const sequence_data *s = ((const sequence *)grid)->data;
    if (s->cache.slot_count > 0) return (field_needs){0};
    uint64_t frame = sequence_frame_bytes(s, 0);
    return (field_needs){.host = frame, .device = grid->blends ? 2 * frame : frame};
}

static const field_playback *playback(const field_grid *grid) {
    return &((const sequence *)grid)->data->cache.counts;
}

static void destroy(field_grid *grid, gpu *g) {
    sequence_data_free(((sequence *)grid)->data, g);
}

// ---- public -----------------------------------------------------------------------------------

static bool sequence_check(sequence_data *s) {
    sequence_desc *d = &s->desc;
    if (d->fps == 0) d->fps = 24;
    if (d->speed == 0) d->speed = 1;
    if (d->scale == 0) d->scale = 1;
    if (d->max_frame_bytes == 0) d->max_frame_bytes = (uint64_t)512 << 20;
    if (d->raw.value_scale == 0) d->raw.value_scale = 1;
    if (!d->raw.channel) d->raw.channel = "density";
    if (!d->raw.axes) d->raw.axes = "xyz";
    if (!isfinite(d->fps) || d->fps < 0)
        return err_set("%s: %g frames a second; more than 0 are accepted", d->pattern, d->fps);
    if (!isfinite(d->speed) || !isfinite(d->start))
        return err_set("%s: start and speed must be finite", d->pattern);
    if (!isfinite(d->scale) || d->scale < 1e-9f || d->scale > 1e9f)
        return err_set("%s: scale %g; more than 0 is accepted", d->pattern, (double)d->scale);
    if (!isfinite(d->offset.x) || !isfinite(d->offset.y) || !isfinite(d->offset.z))
        return err_set("%s: the offset is not finite", d->pattern);
    if ((unsigned)d->storage > SEQUENCE_SPARSE)
        return err_set("%s: unknown storage %d", d->pattern, (int)d->storage);
    if ((unsigned)d->loop >= COUNT_OF(loop_names))
        return err_set("%s: unknown loop mode %d", d->pattern, (int)d->loop);
    return true;
}

static bool open_files(sequence_data *s) {
    if (!sequence_check(s) || !list_files(s)) return false;
    if (s->raw) {
        s->desc.raw.channel = arena_string(&s->memory, s->desc.raw.channel);
        s->desc.raw.axes = arena_string(&s->memory, s->desc.raw.axes);
        if (s->desc.raw.type) s->desc.raw.type = arena_string(&s->memory, s->desc.raw.type);
        if (s->file_count > 1)
            return err_set("%s: one raw file holds all frames, but %zu have such a name",
                           s->desc.pattern, s->file_count);
    }
    if (s->raw ? !sequence_raw_open(s) : !open_vdb(s)) return false;
    place(s);
    return true;
}

sequence *sequence_create(arena *memory, const sequence_desc *desc) {
    sequence_data *d = mem_alloc(sizeof *d);
    d->desc = *desc;
    d->desc.pattern = arena_string(&d->memory, desc->pattern);
    if (desc->root) d->desc.root = arena_string(&d->memory, desc->root);
    d->name = path_name(d->desc.pattern);
    d->label = arena_format(&d->memory, "%s, decoded", d->name);
    d->raw = strcmp(path_extension(desc->pattern), "raw") == 0 || desc->raw.type;
    if (!open_files(d)) {
        sequence_data_free(d, NULL);
        return NULL;
    }
    sequence *s = arena_alloc(memory, sizeof *s);
    s->data = d;
    s->grid = (field_grid){.name = arena_string(memory, d->name),
                           .box = d->box,
                           .size = {d->size[0], d->size[1], d->size[2]},
                           .sparse = d->sparse,
                           .blends = d->desc.blend && d->frame_count > 1,
                           .state = {.active = box3_empty()},
                           .update = update,
                           .destroy = destroy,
                           .exchange = sequence_exchange,
                           .needs = needs,
                           .playback = playback,
                           .field_name = sequence_field_name,
                           .find_field = sequence_find_field};
    return s;
}

field_grid *sequence_grid(sequence *s) {
    return &s->grid;
}

bool sequence_is_sparse(const sequence *s) {
    return s->data->sparse;
}

int64_t sequence_frame_count(const sequence *s) {
    return s->data->span;
}

bool sequence_says_y_up(const sequence *s) {
    return !s->data->raw && s->data->infos[0].y_up;
}

bool sequence_has_numbers(const sequence *s, size_t file, const char *grid) {
    const vdb_info *info = s->data->raw ? NULL : &s->data->infos[file];
    for (size_t i = 0; info && i < info->count; i++)
        if (strcmp(info->grids[i].name, grid) == 0 && info->grids[i].components == 1) return true;
    return false;
}

double sequence_duration(const sequence *s) {
    return (double)s->data->span / s->data->desc.fps;
}

size_t sequence_files(const sequence *s, const char *const **out) {
    *out = s->data->files;
    return s->data->file_count;
}
