// Which lamps may light what a tile of a picture shows, for the pass that reads them: two
// dispatches before its own. Of "all" the first alone, which copies the lamps into a buffer: there
// a value that threads side by side read at once costs one access, in an image one for each of
// them.
#include "base/error.h"
#include "base/memory.h"
#include "pass/lamps_parts.h"
#include <string.h>

enum {
    TILE = 16,   // pixels, as in lib/lamps.glsl
    GROUP = 16,  // threads along a group
    RECORD = 32, // bytes
    HEAD = 16,
    WORD_BITS = 32,
    FEW = 4, // lamps, up to which every pixel may as well look at all
};

static const char shader[] = "pass/lamps_lists.comp";
static const char *const stages[LISTS_STAGES] = {"STAGE_RECORDS", "STAGE_MASKS"};
static const char *const buffer_names[LAMP_BUFFERS] = {"LampRecords", "LampMasks", "LampBounds"};

static lamps_way choose_way(const pass *p, uint32_t count) {
    static const char *const words[] = {"all", "tiles", "volumes"};
    for (size_t i = 0; i < COUNT_OF(words); i++)
        if (pass_has_word(p, "lamps_by", words[i])) return (lamps_way)i;
    return count <= FEW ? LAMPS_ALL : LAMPS_TILES;
}

bool pass_find_lamps(pass *p) {
    int input = pass_find_image(p, "lamps");
    if (input < 0 || p->face->images[input].output || !p->images[input].id) return true;
    const pass *writer = pass_writer(p->host, p->images[input]);
    if (!writer || !pass_is(writer, "point_lights"))
        return err_set("%s: 'lamps' takes a pass point_lights { }, as in lamps = fireflies or "
                       "from = {scene, fireflies}",
                       p->label);
    p->lamps = arena_alloc(p->host->memory, sizeof *p->lamps);
    p->lamps->count = graph_get_desc(p->host->graph, p->images[input])->height;
    p->lamps->way = choose_way(p, p->lamps->count);
    return true;
}

uint32_t pass_lamps_count(const pass *p) {
    return p->lamps ? p->lamps->count : 0;
}

lamps_way pass_lamps_way(const pass *p) {
    return p->lamps ? p->lamps->way : LAMPS_ALL;
}

size_t pass_lamps_defines(const pass *p, shader_define out[PASS_LAMPS_DEFINES]) {
    out[0] = (shader_define){"LAMPS_TILES", pass_lamps_way(p) == LAMPS_TILES ? "1" : "0"};
    out[1] = (shader_define){"LAMPS_VOLUMES", pass_lamps_way(p) == LAMPS_VOLUMES ? "1" : "0"};
    out[2] = (shader_define){"LAMPS_BETWEEN", pass_is(p, "lamp_glows") ? "1" : "0"};
    return PASS_LAMPS_DEFINES;
}

// ---- building ---------------------------------------------------------------------------------

static bool is_used(const pass_lamps *l, int stage) {
    return stage != LISTS_MASKS || l->way == LAMPS_TILES;
}

bool pass_lamps_check(pass *p) {
    for (int i = 0; p->lamps && i < LISTS_STAGES; i++) {
        const shader_define defines[] = {{stages[i], "1"}, {"WITHOUT_FIELDS", "1"}};
        if (is_used(p->lamps, i) && !pass_compile(p, shader, SHADER_COMPUTE, defines,
                                                  COUNT_OF(defines), &p->lamps->binary[i]))
            return false;
    }
    return pass_lamps_way(p) != LAMPS_VOLUMES || lamps_check_volumes(p);
}

bool pass_lamps_build(pass *p) {
    if (!pass_lamps_check(p)) return false;
    for (int i = 0; p->lamps && i < LISTS_STAGES; i++) {
        const shader_binary *binary = &p->lamps->binary[i];
        if (!is_used(p->lamps, i)) continue;
        p->lamps->block[i] = arena_alloc(p->host->memory, pass_block_size(binary) + 16);
        p->lamps->pipeline[i] = pass_create_compute(p, binary);
        if (!p->lamps->pipeline[i]) return false;
    }
    return pass_lamps_way(p) != LAMPS_VOLUMES || lamps_build_volumes(p);
}

void pass_lamps_destroy(pass *p) {
    gpu *device = p->host->device;
    for (int i = 0; p->lamps && i < LISTS_STAGES; i++)
        if (p->lamps->pipeline[i]) gpu_pipeline_destroy(device, p->lamps->pipeline[i]);
    for (int i = 0; p->lamps && i < LAMP_BUFFERS; i++)
        gpu_buffer_destroy(device, p->lamps->buffers[i]);
    if (p->lamps) lamps_destroy_volumes(p);
}

// ---- in a frame -------------------------------------------------------------------------------

typedef struct tiling { // of the picture that the pass writes
    uint32_t width, height, across, down, words;
} tiling;

static tiling tiling_of(const pass *p) {
    uint32_t size[3] = {1, 1, 1};
    for (size_t i = p->face->image_count; i-- > 0;)
        if (p->face->images[i].output) graph_get_size(p->host->graph, p->images[i], size);
    return (tiling){
        .width = size[0],
        .height = size[1],
        .across = (size[0] + TILE - 1) / TILE,
        .down = (size[1] + TILE - 1) / TILE,
        .words = (p->lamps->count + WORD_BITS - 1) / WORD_BITS,
    };
}

static bool make_buffer(pass *p, lists_buffer which, uint64_t size) {
    gpu *device = p->host->device;
    gpu_buffer **buffer = &p->lamps->buffers[which];
    if (*buffer && gpu_buffer_size(*buffer) == size) return true;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set("%s: lists of %u lamps for %llu bytes of tiles are more than the device "
                       "binds (%llu); fewer lamps, lamps_by = \"all\" or a smaller picture need "
                       "less",
                       p->label, p->lamps->count, (unsigned long long)size,
                       (unsigned long long)most);
    gpu_buffer_destroy(device, *buffer);
    *buffer =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = buffer_names[which], .size = size});
    return *buffer != NULL;
}

static bool make_buffers(pass *p, const tiling *t) {
    if (!make_buffer(p, LAMP_RECORDS, HEAD + (uint64_t)RECORD * p->lamps->count)) return false;
    return p->lamps->way != LAMPS_TILES ||
           (make_buffer(p, LAMP_MASKS, 4ull * t->across * t->down * t->words) &&
            make_buffer(p, LAMP_BOUNDS, 8ull * t->across * t->height));
}

static bool run(pass *p, lists_stage stage, const tiling *t, uint32_t x, uint32_t y) {
    const shader_binary *binary = &p->lamps->binary[stage];
    unsigned char *block = p->lamps->block[stage];
    const struct {
        const char *name;
        uint32_t value;
    } members[] = {{"width", t->width},
                   {"height", t->height},
                   {"lamp_count", p->lamps->count},
                   {"lamp_words", t->words},
                   {"lamp_tiles_across", t->across}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = p->lamps->pipeline[stage], .bindings = bindings, .threads = {x, y, 1}};
    for (size_t i = 0; i < COUNT_OF(members); i++)
        pass_write_member(binary, block, members[i].name, &members[i].value, sizeof(uint32_t));
    return pass_bind(p, binary, block, NULL, 0, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool pass_lamps_record(pass *p) {
    if (!p->lamps) return true;
    const tiling t = tiling_of(p);
    uint32_t x = (t.across + GROUP - 1) / GROUP * GROUP, rows = (p->lamps->count + x - 1) / x;
    lamps_way way = p->lamps->way;
    if (way == LAMPS_TILES && rows < t.height) rows = t.height;
    return make_buffers(p, &t) && run(p, LISTS_RECORDS, &t, x, rows) &&
           (way != LAMPS_TILES || run(p, LISTS_MASKS, &t, t.across * t.words, t.down)) &&
           (way != LAMPS_VOLUMES || lamps_draw_volumes(p, t.width, t.height));
}

enum { LAMP_LIGHT = LAMP_BUFFERS, LAMP_SLOTS };
static const char *const slots[LAMP_SLOTS] = {"LampRecords", "LampMasks", "LampBounds",
                                              "LampLight"};

static bool bind(pass *p, int slot, gpu_binding *out) {
    if (!p->lamps) return false;
    out->sampler = GPU_NEAREST_CLAMP;
    if (slot == LAMP_LIGHT)
        out->image = p->lamps->volumes.light;
    else
        out->buffer = p->lamps->buffers[slot];
    return out->image || out->buffer;
}

static size_t defines_of(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    return p->lamps ? pass_lamps_defines(p, out) : 0;
}

const pass_provider pass_lamps_provider = {
    .slots = {slots, LAMP_SLOTS},
    .find = pass_find_lamps,
    .defines = defines_of,
    .check = pass_lamps_check,
    .build = pass_lamps_build,
    .prepare = pass_lamps_record,
    .bind = bind,
    .destroy = pass_lamps_destroy,
};
