// Splats: particles as a picture. What they look like is found for each particle (project); small
// ones are added to the pixels there and then, large ones kept. A scan of how many of these touch
// each tile of the picture makes room for the tiles' lists (scan), which are filled (list) and
// drawn (draw). Nothing is read back: how many there are only the device knows, so that lists have
// a fixed size, and what does not fit is drawn by itself.
//
// Where the order counts, all are kept and listed, and the lists are sorted (splats_sort.c).
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/particles.h"
#include "pass/splats_parts.h"
#include <string.h>

static const char *const stage_defines[SPLATS_STAGES] = {
    "STAGE_PROJECT", "STAGE_SCAN", "STAGE_LIST", "STAGE_BOUNDS", "STAGE_DRAW"};

static const char *const buffer_names[SPLATS_BUFFERS] = {
    "SplatRecords", "SplatSums",   "SplatHead",  "SplatTiles",  "SplatEntries",
    "SplatCounts",  "SplatGroups", "SplatPairs", "SplatSorted", "SplatSortCounts"};

static size_t option(const pass *p, const char *name) {
    size_t index;
    pass_find_key(p, name, &index);
    return p->options[index];
}

// What is not lit by them asks for no light.
static void drop_light(pass *p) {
    static const char *const images[] = {"lights", "shadow", "glow"};
    for (size_t i = 0; i < COUNT_OF(images); i++)
        p->images[pass_find_image(p, images[i])] = (graph_image){0};
}

static bool smokes(const pass *p) { // somebody says what dims it
    size_t index;
    return pass_find_key(p, "density", &index) == PASS_FIELD && p->fields[index];
}

bool splats_declare(pass *p) {
    splats_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->particles = pass_particles_of(p);
    if (!s->particles) return false;
    s->blend = (splats_blend)option(p, "blend");
    if (s->blend == SPLATS_SORTED_BLEND && pass_particles_count(s->particles) > SPLATS_MOST_SORTED)
        return err_set("%s: %u particles are too many to be sorted; blend = \"weighted\" takes "
                       "them, or 'count' of particles at most %d",
                       p->label, pass_particles_count(s->particles), SPLATS_MOST_SORTED);
    if (!option(p, "lit")) drop_light(p);
    if (smokes(p) && !pass_check_density(p)) return false;
    return pass_declare_images(p) && pass_add_to_graph(p);
}

// ---- building ---------------------------------------------------------------------------------

static bool is_used(const splats_state *s, splats_stage stage) {
    return stage != SPLATS_BOUNDS || s->blend == SPLATS_SORTED_BLEND;
}

// What suits processors whose threads take turns: no waiting for each other, and a splat's own
// thread draws it up to that many pixels to each side, since reading a splat for each pixel is dear
// there.
static bool is_software(const pass *p) {
    return p->host->device && gpu_get_info(p->host->device)->kind == GPU_CPU;
}

static bool compile(pass *p, splats_stage stage) {
    splats_state *s = splats_of(p);
    shader_define defines[PASS_PARTICLES_DEFINES + 4];
    size_t count = pass_particles_defines(s->particles, defines);
    defines[count++] = (shader_define){stage_defines[stage], "1"};
    defines[count++] = (shader_define){"GATHERED", is_software(p) ? "0" : "1"};
    defines[count++] = (shader_define){"DIRECT", is_software(p) ? "24.0" : "0.0"};
    if (stage != SPLATS_PROJECT) defines[count++] = (shader_define){"WITHOUT_FIELDS", "1"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &s->binary[stage]);
}

bool splats_check(pass *p) {
    splats_state *s = splats_of(p);
    for (int i = 0; i < SPLATS_STAGES; i++)
        if (is_used(s, (splats_stage)i) && !compile(p, (splats_stage)i)) return false;
    return s->blend != SPLATS_SORTED_BLEND || splats_compile_sort(p);
}

bool splats_build(pass *p) {
    splats_state *s = splats_of(p);
    for (int i = 0; i < SPLATS_STAGES; i++) {
        if (!is_used(s, (splats_stage)i)) continue;
        if (!compile(p, (splats_stage)i)) return false;
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        s->block[i] = arena_alloc(p->host->memory, pass_block_size(&s->binary[i]) + 16);
        if (!s->pipeline[i]) return false;
    }
    p->binary = s->binary[SPLATS_PROJECT];
    return s->blend != SPLATS_SORTED_BLEND || splats_build_sort(p);
}

void splats_destroy(pass *p) {
    splats_state *s = splats_of(p);
    gpu *device = p->host->device;
    for (int i = 0; s && i < SPLATS_STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(device, s->pipeline[i]);
    for (int i = 0; s && i < SPLATS_SORT_STAGES; i++)
        if (s->sort_pipeline[i]) gpu_pipeline_destroy(device, s->sort_pipeline[i]);
    for (int i = 0; s && i < SPLATS_BUFFERS; i++) gpu_buffer_destroy(device, s->buffers[i]);
}

// ---- memory -----------------------------------------------------------------------------------

static uint32_t record_count(const splats_state *s) {
    uint32_t count = pass_particles_count(s->particles), most = SPLATS_MOST_RECORDS;
    return s->blend == SPLATS_SORTED_BLEND || count < most ? count : most;
}

uint32_t splats_entries(const pass *p) {
    return record_count(splats_of(p)) * pass_number(p, "entries");
}

static void picture_size(const pass *p, uint32_t size[3]) {
    graph_get_size(p->host->graph, pass_output(p, "image"), size);
}

static uint32_t tiles_along(uint32_t pixels) {
    return (pixels + SPLATS_TILE - 1) / SPLATS_TILE;
}

uint32_t splats_tile_count(const pass *p) {
    uint32_t size[3];
    picture_size(p, size);
    return tiles_along(size[0]) * tiles_along(size[1]);
}

static uint32_t group_count(uint32_t particles) {
    return (particles + SPLATS_GROUP - 1) / SPLATS_GROUP;
}

bool splats_make_buffer(pass *p, splats_buffer which, uint64_t size) {
    splats_state *s = splats_of(p);
    gpu *device = p->host->device;
    if (s->buffers[which] && gpu_buffer_size(s->buffers[which]) == size) return true;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set("%s: %llu bytes are needed at once, and the device binds %llu at most; "
                       "a smaller 'resolution', fewer 'entries' or particles need less",
                       p->label, (unsigned long long)size, (unsigned long long)most);
    if (s->buffers[which]) gpu_buffer_destroy(device, s->buffers[which]);
    s->buffers[which] =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = buffer_names[which], .size = size});
    s->empty = s->empty && which != SPLATS_SUMS;
    return s->buffers[which] != NULL;
}

static bool make_buffers(pass *p) {
    const splats_state *s = splats_of(p);
    uint32_t size[3];
    uint64_t records = record_count(s), channels = s->blend == SPLATS_WEIGHTED ? 5 : 3;
    picture_size(p, size);
    if (!splats_make_buffer(p, SPLATS_RECORDS, records * SPLATS_RECORD) ||
        !splats_make_buffer(p, SPLATS_HEAD, 16) ||
        !splats_make_buffer(p, SPLATS_TILES, 8ull * splats_tile_count(p)))
        return false;
    if (s->blend != SPLATS_SORTED_BLEND)
        return splats_make_buffer(p, SPLATS_SUMS, 4 * channels * size[0] * size[1]) &&
               splats_make_buffer(p, SPLATS_ENTRIES, 4ull * splats_entries(p));
    return splats_make_buffer(p, SPLATS_COUNTS, 4 * records) &&
           splats_make_buffer(p, SPLATS_GROUPS, 4ull * group_count((uint32_t)records)) &&
           splats_make_sort(p);
}

// ---- in a frame -------------------------------------------------------------------------------

// The box of the smoke that dims.
static bool write_smoke(pass *p, const shader_binary *binary, unsigned char *block) {
    box3 box = {{0, 0, 0}, {0, 0, 0}};
    if (smokes(p) && !pass_density_box(p, &box)) return false;
    pass_write_box(binary, block, box);
    return true;
}

bool splats_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const splats_state *s = splats_of(p);
    uint32_t size[3];
    picture_size(p, size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    const struct {
        const char *name;
        uint32_t value;
    } counts[] = {
        {"tiles_across", tiles_along(size[0])},
        {"tiles_down", tiles_along(size[1])},
        {"records_most", record_count(s)},
        {"entries_most", splats_entries(p)},
        {"group_count", group_count(pass_particles_used(s->particles))},
        {"depth_bits", splats_depth_bits(p)},
    };
    pass_write_member(binary, block, "picture", picture, sizeof picture);
    for (size_t i = 0; i < COUNT_OF(counts); i++)
        pass_write_member(binary, block, counts[i].name, &counts[i].value, sizeof(uint32_t));
    pass_particles_write(s->particles, binary, block);
    return write_smoke(p, binary, block);
}

static size_t list_slots(const pass *p, const shader_binary *binary,
                         pass_override out[GPU_MAX_SLOTS]) {
    const splats_state *s = splats_of(p);
    size_t count = 0;
    for (size_t i = 0; i < binary->slot_count && count < GPU_MAX_SLOTS; i++) {
        pass_override *slot = &out[count];
        *slot = (pass_override){.name = binary->slots[i].name};
        for (int b = 0; b < SPLATS_BUFFERS; b++)
            if (strcmp(buffer_names[b], slot->name) == 0) slot->binding.buffer = s->buffers[b];
        count +=
            slot->binding.buffer || pass_particles_bind(s->particles, slot->name, &slot->binding);
    }
    return count;
}

static bool dispatch(pass *p, splats_stage stage, uint32_t x, uint32_t y) {
    splats_state *s = splats_of(p);
    const shader_binary *binary = &s->binary[stage];
    pass_override overrides[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = s->pipeline[stage], .bindings = bindings, .threads = {x, y, 1}};
    size_t count = list_slots(p, binary, overrides);
    return pass_fill_block(p, binary, s->block[stage]) &&
           pass_bind(p, binary, s->block[stage], overrides, count, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

// A thread for each of `count`, in rows of groups.
static bool dispatch_each(pass *p, splats_stage stage, uint32_t count) {
    uint32_t groups = group_count(count);
    uint32_t across = groups < SPLATS_ACROSS ? groups : SPLATS_ACROSS;
    return count == 0 || dispatch(p, stage, across * SPLATS_GROUP, (groups + across - 1) / across);
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
    uint32_t size[3], kept = used < record_count(s) ? used : record_count(s);
    picture_size(p, size);
    if (!s->empty) gpu_buffer_fill(p->host->device, s->buffers[SPLATS_SUMS], 0);
    s->empty = false; // until they are drawn
    s->empty = dispatch_each(p, SPLATS_PROJECT, used) &&
               dispatch(p, SPLATS_SCAN, SPLATS_GROUP, 1) && dispatch_each(p, SPLATS_LIST, kept) &&
               dispatch(p, SPLATS_DRAW, size[0], size[1]);
    return s->empty;
}

bool splats_record(pass *p) {
    splats_state *s = splats_of(p);
    gpu *device = p->host->device;
    if (!pass_prepare(p) || !make_buffers(p)) return false;
    gpu_buffer_fill(device, s->buffers[SPLATS_HEAD], 0);
    gpu_buffer_fill(device, s->buffers[SPLATS_TILES], 0);
    uint32_t used = pass_particles_used(s->particles);
    return s->blend == SPLATS_SORTED_BLEND ? draw_sorted(p, used) : draw_sums(p, used);
}
