// Splats: particles as a picture. What they look like is found for each particle (project); small
// ones are added to the pixels there and then, large ones kept. A scan of how many of these touch
// each tile of the picture makes room for the tiles' lists (scan), which are filled (list) and
// drawn (draw). Nothing is read back: how many there are only the device knows, so that lists have
// a fixed size, and what does not fit is drawn by itself.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/particles.h"
#include "pass/pass_impl.h"
#include <stdlib.h>
#include <string.h>

enum {
    TILE = 16,
    GROUP = 256,          // threads of a group that has one for each particle
    GROUPS_ACROSS = 1024, // of such groups: a device takes 65535 along each side
    RECORD = 48,          // bytes of a splat that is kept
    MOST_RECORDS = 1 << 20,
};

typedef enum splats_stage { PROJECT, SCAN, LIST, DRAW, STAGES } splats_stage;
static const char *const stage_defines[STAGES] = {"STAGE_PROJECT", "STAGE_SCAN", "STAGE_LIST",
                                                  "STAGE_DRAW"};

typedef enum splats_buffer { RECORDS, SUMS, HEAD, TILES, ENTRIES, BUFFERS } splats_buffer;
static const char *const buffer_names[BUFFERS] = {"SplatRecords", "SplatSums", "SplatHead",
                                                  "SplatTiles", "SplatEntries"};

typedef struct splats_state {
    const pass *particles;
    shader_binary binary[STAGES];
    gpu_pipeline *pipeline[STAGES];
    unsigned char *block[STAGES];
    gpu_buffer *buffers[BUFFERS];
    bool empty; // the sums are
} splats_state;

bool splats_declare(pass *p) {
    splats_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->particles = pass_particles_of(p);
    return s->particles && pass_declare_images(p) && pass_add_to_graph(p);
}

static const char *word(const pass *p, const char *option) {
    size_t index;
    pass_find_key(p, option, &index);
    return p->face->options[index].words[p->options[index]];
}

// ---- building ---------------------------------------------------------------------------------

static bool compile(pass *p, splats_stage stage, shader_binary *out) {
    const splats_state *s = p->state;
    shader_define defines[PASS_PARTICLES_DEFINES + 2];
    size_t count = pass_particles_defines(s->particles, defines);
    defines[count++] = (shader_define){stage_defines[stage], "1"};
    if (stage != PROJECT) defines[count++] = (shader_define){"WITHOUT_FIELDS", "1"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, out);
}

bool splats_check(pass *p) {
    shader_binary binary;
    for (int i = 0; i < STAGES; i++)
        if (!compile(p, (splats_stage)i, &binary)) return false;
    return true;
}

bool splats_build(pass *p) {
    splats_state *s = p->state;
    for (int i = 0; i < STAGES; i++) {
        if (!compile(p, (splats_stage)i, &s->binary[i])) return false;
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        s->block[i] = arena_alloc(p->host->memory, pass_block_size(&s->binary[i]) + 16);
        if (!s->pipeline[i]) return false;
    }
    p->binary = s->binary[PROJECT];
    return true;
}

void splats_destroy(pass *p) {
    splats_state *s = p->state;
    for (int i = 0; s && i < STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
    for (int i = 0; s && i < BUFFERS; i++) gpu_buffer_destroy(p->host->device, s->buffers[i]);
}

// ---- memory -----------------------------------------------------------------------------------

static uint32_t record_count(const splats_state *s) {
    uint32_t count = pass_particles_count(s->particles);
    return count < MOST_RECORDS ? count : MOST_RECORDS;
}

static uint32_t entry_count(const pass *p) {
    return record_count(p->state) * (uint32_t)strtoul(word(p, "entries"), NULL, 10);
}

static void picture_size(const pass *p, uint32_t size[3]) {
    graph_get_size(p->host->graph, pass_output(p, "image"), size);
}

static uint32_t tiles_along(uint32_t pixels) {
    return (pixels + TILE - 1) / TILE;
}

static bool make_buffer(pass *p, splats_buffer which, uint64_t size) {
    splats_state *s = p->state;
    gpu *device = p->host->device;
    if (s->buffers[which] && gpu_buffer_size(s->buffers[which]) == size) return true;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set("%s: %llu bytes are needed at once, and the device binds %llu at most; a "
                       "smaller 'resolution', fewer 'entries' or particles need less",
                       p->label, (unsigned long long)size, (unsigned long long)most);
    gpu_buffer_destroy(device, s->buffers[which]);
    s->buffers[which] =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = buffer_names[which], .size = size});
    s->empty = s->empty && which != SUMS;
    return s->buffers[which] != NULL;
}

static bool make_buffers(pass *p, const uint32_t size[3]) {
    uint64_t channels = strcmp(word(p, "blend"), "weighted") == 0 ? 5 : 3;
    uint64_t tiles = (uint64_t)tiles_along(size[0]) * tiles_along(size[1]);
    return make_buffer(p, RECORDS, (uint64_t)record_count(p->state) * RECORD) &&
           make_buffer(p, SUMS, 4 * channels * size[0] * size[1]) && make_buffer(p, HEAD, 16) &&
           make_buffer(p, TILES, 8 * tiles) && make_buffer(p, ENTRIES, 4ull * entry_count(p));
}

// ---- in a frame -------------------------------------------------------------------------------

// The smoke that dims: without an end it is everywhere that the eye sees.
static bool write_smoke(pass *p, const shader_binary *binary, unsigned char *block) {
    size_t index;
    box3 box = {{0, 0, 0}, {0, 0, 0}};
    bool given = pass_find_key(p, "density", &index) == PASS_FIELD && p->fields[index];
    if (given && !pass_density_box(p, &box)) return false;
    pass_write_box(binary, block, box);
    return true;
}

bool splats_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const splats_state *s = p->state;
    uint32_t size[3];
    picture_size(p, size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    const uint32_t across = tiles_along(size[0]), down = tiles_along(size[1]);
    const uint32_t records = record_count(s), entries = entry_count(p);
    pass_write_member(binary, block, "picture", picture, sizeof picture);
    pass_write_member(binary, block, "tiles_across", &across, sizeof across);
    pass_write_member(binary, block, "tiles_down", &down, sizeof down);
    pass_write_member(binary, block, "records_most", &records, sizeof records);
    pass_write_member(binary, block, "entries_most", &entries, sizeof entries);
    pass_particles_write(s->particles, binary, block);
    return write_smoke(p, binary, block);
}

static size_t list_slots(const pass *p, const shader_binary *binary,
                         pass_override out[GPU_MAX_SLOTS]) {
    const splats_state *s = p->state;
    size_t count = 0;
    for (size_t i = 0; i < binary->slot_count && count < GPU_MAX_SLOTS; i++) {
        pass_override *slot = &out[count];
        *slot = (pass_override){.name = binary->slots[i].name};
        for (int b = 0; b < BUFFERS; b++)
            if (strcmp(buffer_names[b], slot->name) == 0) slot->binding.buffer = s->buffers[b];
        count +=
            slot->binding.buffer || pass_particles_bind(s->particles, slot->name, &slot->binding);
    }
    return count;
}

static bool dispatch(pass *p, splats_stage stage, uint32_t x, uint32_t y) {
    splats_state *s = p->state;
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
    uint32_t groups = (count + GROUP - 1) / GROUP;
    uint32_t across = groups < GROUPS_ACROSS ? groups : GROUPS_ACROSS;
    return count == 0 || dispatch(p, stage, across * GROUP, (groups + across - 1) / across);
}

bool splats_record(pass *p) {
    splats_state *s = p->state;
    gpu *device = p->host->device;
    uint32_t size[3], used = pass_particles_used(s->particles);
    picture_size(p, size);
    if (!pass_prepare(p) || !make_buffers(p, size)) return false;
    if (!s->empty) gpu_buffer_fill(device, s->buffers[SUMS], 0);
    gpu_buffer_fill(device, s->buffers[HEAD], 0);
    gpu_buffer_fill(device, s->buffers[TILES], 0);
    s->empty = false; // until they are drawn
    uint32_t kept = used < record_count(s) ? used : record_count(s);
    s->empty = dispatch_each(p, PROJECT, used) && dispatch(p, SCAN, GROUP, 1) &&
               dispatch_each(p, LIST, kept) && dispatch(p, DRAW, size[0], size[1]);
    return s->empty;
}
