// Splats: particles as a picture. What they look like is found for each particle (project); small
// ones are added to the pixels there and then, large ones kept. A scan of how many of these touch
// each tile of the picture makes room for the tiles' lists (scan), which are filled (list) and
// drawn (draw). Nothing is read back: how many there are only the device knows, so that lists have
// a fixed size, and what does not fit is drawn by itself.
//
// Where the order counts, all are kept and listed. Entries of the lists are then pairs of a key and
// a splat, which the device sorts by as many digits as tiles and depth need.
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "pass/particles/particles.h"
#include "pass/pass_impl.h"
#include <string.h>

enum {
    SPLATS_TILE = 16,              // pixels along a tile
    SPLATS_GROUP = 256,            // threads of a group that has one for each particle
    SPLATS_RECORD = 48,            // bytes of a splat that is kept
    SPLATS_MOST_RECORDS = 1 << 20, // kept, where others are drawn by themselves,
    SPLATS_MOST_SORTED = 2097152,  // and where none is

    DIGIT_BITS = 4, // of a key, that are sorted at once
    ITEMS = 16,     // of a thread, as in splats/sort.comp
    KEY_BITS = 32,
    DEPTH_BITS = 16, // unless tiles need more of the key
};

typedef enum splats_stage {
    SPLATS_PROJECT,
    SPLATS_SCAN,
    SPLATS_LIST,
    SPLATS_BOUNDS, // of what is sorted, as the last three
    SPLATS_DRAW,
    SPLATS_SORT_COUNT,
    SPLATS_SORT_SCAN,
    SPLATS_SORT_MOVE,
    SPLATS_STAGES
} splats_stage;

// Buffers first: splats_buffer counts as they do.
#define SPLATS_NAMES(NAME)                                                                         \
    NAME(SplatRecords), NAME(SplatSums), NAME(SplatHead), NAME(SplatTiles), NAME(SplatEntries),    \
        NAME(SplatCounts), NAME(SplatGroups), NAME(SplatPairs), NAME(SortTo), NAME(SortCounts),    \
        NAME(SortFrom), NAME(blend), NAME(lit), NAME(entries), NAME(lights), NAME(shadow),         \
        NAME(glow), NAME(image), NAME(picture), NAME(tiles_across), NAME(tiles_down),              \
        NAME(records_most), NAME(entries_most), NAME(group_count), NAME(depth_bits), NAME(shift)
KERNEL_NAMES(SPLATS_NAMES);

typedef enum splats_buffer {
    SPLATS_RECORDS,
    SPLATS_SUMS,
    SPLATS_HEAD,
    SPLATS_TILES,
    SPLATS_ENTRIES,
    SPLATS_COUNTS, // from here on: of what is sorted
    SPLATS_GROUPS,
    SPLATS_PAIRS,
    SPLATS_SORTED, // the other of two between which pairs go to and fro
    SPLATS_SORT_COUNTS,
    SPLATS_BUFFERS
} splats_buffer;

typedef enum splats_blend { SPLATS_ADDITIVE, SPLATS_WEIGHTED, SPLATS_SORTED_BLEND } splats_blend;

typedef struct splats_state {
    splats_blend blend;
    uint32_t places; // in the lists, for each particle
    gpu_buffer *buffers[SPLATS_BUFFERS];
    bool empty; // the sums are
} splats_state;

static inline splats_state *splats_of(const pass *p) {
    return p->state;
}

static const char sort_shader[] = "pass/particles/splats/sort.comp";
static const pass_kernel kernels[SPLATS_STAGES] = {
    [SPLATS_PROJECT] = {.define = "STAGE_PROJECT"},
    [SPLATS_SCAN] = {.define = "STAGE_SCAN", .without_fields = true},
    [SPLATS_LIST] = {.define = "STAGE_LIST", .without_fields = true},
    [SPLATS_BOUNDS] = {.define = "STAGE_BOUNDS", .without_fields = true},
    [SPLATS_DRAW] = {.define = "STAGE_DRAW", .without_fields = true},
    [SPLATS_SORT_COUNT] = {sort_shader, .define = "STAGE_SORT_COUNT", .without_fields = true},
    [SPLATS_SORT_SCAN] = {sort_shader, .define = "STAGE_SORT_SCAN", .without_fields = true},
    [SPLATS_SORT_MOVE] = {sort_shader, .define = "STAGE_SORT_MOVE", .without_fields = true},
};

// What is not lit by them asks for no light.
static void drop_light(pass *p) {
    static const int images[] = {N_lights, N_shadow, N_glow};
    for (size_t i = 0; i < COUNT_OF(images); i++) *pass_image(p, images[i]) = (graph_image){0};
}

static bool is_sorted(const pass *p) {
    return splats_of(p)->blend == SPLATS_SORTED_BLEND;
}

static bool splats_declare(pass *p) {
    splats_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->blend = (splats_blend)pass_option(p, N_blend);
    s->places = pass_option_number(p, N_entries);
    if (is_sorted(p) && pass_particles_count(p->particles) > SPLATS_MOST_SORTED)
        return err_set("%s: %u particles are too many to be sorted; blend = \"weighted\" takes "
                       "them, or 'count' of particles at most %d",
                       p->label, pass_particles_count(p->particles), SPLATS_MOST_SORTED);
    if (!pass_option(p, N_lit)) drop_light(p);
    if (pass_density(p) && !pass_check_density(p)) return false;
    return pass_declare_images(p) && pass_add_to_graph(p);
}

// ---- building ---------------------------------------------------------------------------------

static uint32_t group_threads(const pass *p) {
    return gpu_get_profile(p->host->device)->sort_threads;
}

static bool splats_defines(pass *p, size_t index, pass_defines *out) {
    if ((index == SPLATS_BOUNDS || index > SPLATS_DRAW) && !is_sorted(p)) return false;
    if (index > SPLATS_DRAW) {
        pass_define(out, "SORT_THREADS", arena_format(p->host->memory, "%uu", group_threads(p)));
        return true;
    }
    const gpu_profile *device = gpu_get_profile(p->host->device);
    pass_define_flag(out, "GATHERED", device->draws_by_groups);
    pass_define(out, "DIRECT",
                arena_format(p->host->memory, "%.1f", (double)device->splats_direct));
    return true;
}

static void splats_destroy(pass *p) {
    splats_state *s = splats_of(p);
    for (int i = 0; s && i < SPLATS_BUFFERS; i++)
        gpu_buffer_destroy(p->host->device, s->buffers[i]);
}

// ---- memory -----------------------------------------------------------------------------------

static uint32_t record_count(const pass *p) {
    uint32_t count = pass_particles_count(p->particles), most = SPLATS_MOST_RECORDS;
    return is_sorted(p) || count < most ? count : most;
}

static uint32_t splats_entries(const pass *p) {
    return record_count(p) * splats_of(p)->places;
}

static void picture_size(const pass *p, uint32_t size[3]) {
    graph_get_size(p->host->graph, *pass_image(p, N_image), size);
}

static uint32_t tiles_along(uint32_t pixels) {
    return (pixels + SPLATS_TILE - 1) / SPLATS_TILE;
}

static uint32_t splats_tile_count(const pass *p) {
    uint32_t size[3];
    picture_size(p, size);
    return tiles_along(size[0]) * tiles_along(size[1]);
}

static uint32_t group_count(uint32_t particles) {
    return (particles + SPLATS_GROUP - 1) / SPLATS_GROUP;
}

static uint32_t block_count(const pass *p) {
    uint32_t each = ITEMS * group_threads(p);
    return (splats_entries(p) + each - 1) / each;
}

static bool make_buffer(pass *p, splats_buffer which, uint64_t size) {
    splats_state *s = splats_of(p);
    gpu *device = p->host->device;
    if (s->buffers[which] && gpu_buffer_size(s->buffers[which]) == size) return true;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set("%s: %llu bytes are needed at once, and the device binds %llu at most; "
                       "a smaller 'resolution', fewer 'entries' or particles need less",
                       p->label, (unsigned long long)size, (unsigned long long)most);
    s->empty = s->empty && which != SPLATS_SUMS;
    return gpu_buffer_make(device, &s->buffers[which], names[which], size);
}

// Bytes; 0: not needed.
static void find_sizes(const pass *p, uint64_t out[SPLATS_BUFFERS]) {
    const splats_state *s = splats_of(p);
    const uint64_t records = record_count(p), channels = s->blend == SPLATS_WEIGHTED ? 5 : 3;
    uint32_t size[3];
    picture_size(p, size);
    memset(out, 0, SPLATS_BUFFERS * sizeof *out);
    out[SPLATS_RECORDS] = records * SPLATS_RECORD;
    out[SPLATS_HEAD] = 16;
    out[SPLATS_TILES] = 8ull * splats_tile_count(p);
    if (!is_sorted(p)) {
        out[SPLATS_SUMS] = 4 * channels * size[0] * size[1];
        out[SPLATS_ENTRIES] = 4ull * splats_entries(p);
        return;
    }
    out[SPLATS_COUNTS] = 4 * records;
    out[SPLATS_GROUPS] = 4ull * group_count((uint32_t)records);
    out[SPLATS_PAIRS] = out[SPLATS_SORTED] = 8ull * splats_entries(p);
    out[SPLATS_SORT_COUNTS] = (4ull << DIGIT_BITS) * block_count(p);
}

static bool make_buffers(pass *p) {
    uint64_t sizes[SPLATS_BUFFERS];
    find_sizes(p, sizes);
    for (int i = 0; i < SPLATS_BUFFERS; i++)
        if (sizes[i] && !make_buffer(p, (splats_buffer)i, sizes[i])) return false;
    return true;
}

static void splats_list_memory(const pass *p, budget_list *out) {
    const splats_state *s = splats_of(p);
    uint64_t sizes[SPLATS_BUFFERS];
    find_sizes(p, sizes);
    for (int i = 0; i < SPLATS_BUFFERS; i++)
        if (!s->buffers[i] || gpu_buffer_size(s->buffers[i]) != sizes[i])
            budget_list_add(out, names[i], sizes[i]);
}

// ---- in a frame -------------------------------------------------------------------------------

static uint32_t tile_bits(const pass *p) {
    uint32_t bits = 1;
    while (bits < KEY_BITS - 1 && (splats_tile_count(p) - 1) >> bits) bits++;
    return bits;
}

static uint32_t splats_depth_bits(const pass *p) {
    uint32_t left = KEY_BITS - tile_bits(p);
    return left < DEPTH_BITS ? left : DEPTH_BITS;
}

static bool splats_update(pass *p) {
    box3 smoke = box3_empty(); // that dims
    uint32_t size[3];
    picture_size(p, size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    if (pass_density(p) && !pass_density_box(p, &smoke)) return false;
    pass_set(p, N_picture, picture, sizeof picture);
    pass_set_int(p, N_tiles_across, (int32_t)tiles_along(size[0]));
    pass_set_int(p, N_tiles_down, (int32_t)tiles_along(size[1]));
    pass_set_int(p, N_records_most, (int32_t)record_count(p));
    pass_set_int(p, N_entries_most, (int32_t)splats_entries(p));
    pass_set_int(p, N_group_count, (int32_t)group_count(pass_particles_used(p->particles)));
    pass_set_int(p, N_depth_bits, (int32_t)splats_depth_bits(p));
    pass_set_box(p, smoke);
    return true;
}

static kernel *use(pass *p, splats_stage stage) {
    const splats_state *s = splats_of(p);
    kernel *k = pass_use(p, stage);
    for (int i = 0; k && i < SPLATS_BUFFERS; i++) kernel_bind_buffer(k, i, s->buffers[i]);
    return k;
}

static bool dispatch(pass *p, splats_stage stage, uint32_t x, uint32_t y) {
    kernel *k = use(p, stage);
    return k && kernel_run(k, p->host->device, x, y, 1);
}

static bool dispatch_each(pass *p, splats_stage stage, uint32_t count) {
    kernel *k = use(p, stage);
    return k && kernel_run_each(k, p->host->device, count);
}

static bool sort_run(pass *p, splats_stage stage, uint32_t threads) {
    splats_state *s = splats_of(p);
    kernel *k = pass_use(p, stage);
    if (!k) return false;
    kernel_bind_buffer(k, N_SortFrom, s->buffers[SPLATS_PAIRS]);
    kernel_bind_buffer(k, N_SortTo, s->buffers[SPLATS_SORTED]);
    kernel_bind_buffer(k, N_SortCounts, s->buffers[SPLATS_SORT_COUNTS]);
    kernel_bind_buffer(k, N_SplatHead, s->buffers[SPLATS_HEAD]);
    return kernel_run(k, p->host->device, threads, 1, 1);
}

static bool splats_sort(pass *p) {
    splats_state *s = splats_of(p);
    uint32_t threads = group_threads(p), bits = splats_depth_bits(p) + tile_bits(p);
    for (uint32_t shift = 0; shift < bits; shift += DIGIT_BITS) {
        pass_set_int(p, N_shift, (int32_t)shift);
        if (!sort_run(p, SPLATS_SORT_COUNT, threads * block_count(p)) ||
            !sort_run(p, SPLATS_SORT_SCAN, threads) ||
            !sort_run(p, SPLATS_SORT_MOVE, threads * block_count(p)))
            return false;
        SWAP(s->buffers[SPLATS_SORTED], s->buffers[SPLATS_PAIRS]);
    }
    return true;
}

static bool draw_sorted(pass *p, uint32_t used) {
    uint32_t size[3];
    picture_size(p, size);
    return dispatch_each(p, SPLATS_PROJECT, used) && dispatch(p, SPLATS_SCAN, SPLATS_GROUP, 1) &&
           dispatch_each(p, SPLATS_LIST, used) && splats_sort(p) &&
           dispatch_each(p, SPLATS_BOUNDS, splats_entries(p)) &&
           dispatch(p, SPLATS_DRAW, size[0], size[1]);
}

static bool draw_sums(pass *p, uint32_t used) {
    splats_state *s = splats_of(p);
    uint32_t size[3], kept = used < record_count(p) ? used : record_count(p);
    picture_size(p, size);
    if (!s->empty) gpu_buffer_fill(p->host->device, s->buffers[SPLATS_SUMS], 0);
    s->empty = false; // until they are drawn
    s->empty = dispatch_each(p, SPLATS_PROJECT, used) &&
               dispatch(p, SPLATS_SCAN, SPLATS_GROUP, 1) && dispatch_each(p, SPLATS_LIST, kept) &&
               dispatch(p, SPLATS_DRAW, size[0], size[1]);
    return s->empty;
}

static bool splats_record(pass *p) {
    splats_state *s = splats_of(p);
    gpu *device = p->host->device;
    if (!pass_prepare(p) || !make_buffers(p)) return false;
    gpu_buffer_fill(device, s->buffers[SPLATS_HEAD], 0);
    gpu_buffer_fill(device, s->buffers[SPLATS_TILES], 0);
    uint32_t used = pass_particles_used(p->particles);
    return is_sorted(p) ? draw_sorted(p, used) : draw_sums(p, used);
}

const pass_type splats_type = {
    .name = "splats",
    .shader = "pass/particles/splats.comp",
    PASS_KERNELS,
    .declare = splats_declare,
    .defines = splats_defines,
    .list_memory = splats_list_memory,
    .update = splats_update,
    .record = splats_record,
    .destroy = splats_destroy,
};
