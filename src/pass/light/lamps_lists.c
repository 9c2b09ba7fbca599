// Which lamps may light what a tile of a picture shows, for the pass that reads them: two
// dispatches before its own. Of "all" the first alone, which copies the lamps into a buffer: there
// a value that threads side by side read at once costs one access, in an image one for each of
// them.
#include "base/error.h"
#include "base/memory.h"
#include "pass/light/lamps_parts.h"
#include <string.h>

enum {
    TILE = 16,   // pixels, as in lib/lamps.glsl
    GROUP = 16,  // threads along a group
    RECORD = 32, // bytes
    HEAD = 16,
    WORD_BITS = 32,
    FEW = 4, // lamps, up to which every pixel may as well look at all
};

static const pass_kernel kernels[LAMPS_KERNELS] = {
    [LAMPS_RECORDS] = {.shader = "pass/light/lamps_lists.comp",
                       .define = "STAGE_RECORDS",
                       .without_fields = true},
    [LAMPS_MASKS] = {.shader = "pass/light/lamps_lists.comp",
                     .define = "STAGE_MASKS",
                     .without_fields = true},
    [LAMPS_DRAW] = {.shader = "pass/light/lamps_volume.frag",
                    .vertex = "pass/light/lamps_volume.vert",
                    .without_fields = true},
};
static const char *const names[] = {LAMPS_NAMES(KERNEL_NAME_TEXT)};
static const char *const labels[LAMP_BUFFERS] = {[LAMP_RECORDS] = "records of lamps",
                                                 [LAMP_MASKS] = "lamps by tiles",
                                                 [LAMP_BOUNDS] = "depths of tiles"};

static lamps_way choose_way(const pass *p, uint32_t count) {
    static const char *const words[] = {"all", "tiles", "volumes"};
    for (size_t i = 0; i < COUNT_OF(words); i++)
        if (pass_has_word(p, "lamps_by", words[i])) return (lamps_way)i;
    return count <= FEW ? LAMPS_ALL : LAMPS_TILES;
}

static bool find_lamps(pass *p) {
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

static size_t lamps_defines(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    if (!p->lamps) return 0;
    out[0] = (shader_define){"LAMPS_TILES", pass_lamps_way(p) == LAMPS_TILES ? "1" : "0"};
    out[1] = (shader_define){"LAMPS_VOLUMES", pass_lamps_way(p) == LAMPS_VOLUMES ? "1" : "0"};
    out[2] = (shader_define){"LAMPS_BETWEEN", pass_is(p, "lamp_glows") ? "1" : "0"};
    return 3;
}

// ---- building ---------------------------------------------------------------------------------

static bool uses_lamps(const pass *p) {
    return p->lamps != NULL;
}

static bool wants_kernel(const pass *p, size_t index) {
    if (index == LAMPS_RECORDS) return true;
    return p->lamps->way == (index == LAMPS_MASKS ? LAMPS_TILES : LAMPS_VOLUMES);
}

static void lamps_destroy(pass *p) {
    for (int i = 0; p->lamps && i < LAMP_BUFFERS; i++)
        gpu_buffer_destroy(p->host->device, p->lamps->buffers[i]);
    if (p->lamps) gpu_image_destroy(p->host->device, p->lamps->light);
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

static uint64_t bytes_of(const pass *p, const tiling *t, lists_buffer which) { // 0: none
    if (which == LAMP_RECORDS) return HEAD + (uint64_t)RECORD * p->lamps->count;
    if (p->lamps->way != LAMPS_TILES) return 0;
    return which == LAMP_MASKS ? 4ull * t->across * t->down * t->words
                               : 8ull * t->across * t->height;
}

static void lamps_list_memory(const pass *p, budget_list *out) {
    if (!p->lamps) return;
    const tiling t = tiling_of(p);
    for (lists_buffer i = 0; i < LAMP_BUFFERS; i++) {
        const gpu_buffer *now = p->lamps->buffers[i];
        const uint64_t bytes = bytes_of(p, &t, i);
        if (!now || gpu_buffer_size(now) != bytes) budget_list_add(out, labels[i], bytes);
    }
    if (p->lamps->way == LAMPS_VOLUMES) lamps_list_light(p, t.width, t.height, out);
}

static bool make_buffer(pass *p, lists_buffer which, uint64_t size) {
    gpu *device = p->host->device;
    gpu_buffer **buffer = &p->lamps->buffers[which];
    if (size == 0 || (*buffer && gpu_buffer_size(*buffer) == size)) return true;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set("%s: lists of %u lamps for %llu bytes of tiles are more than the device "
                       "binds (%llu); fewer lamps, lamps_by = \"all\" or a smaller picture need "
                       "less",
                       p->label, p->lamps->count, (unsigned long long)size,
                       (unsigned long long)most);
    gpu_buffer_destroy(device, *buffer);
    *buffer = gpu_buffer_create(device, &(gpu_buffer_desc){.label = labels[which], .size = size});
    return *buffer != NULL;
}

static bool make_buffers(pass *p, const tiling *t) {
    for (lists_buffer i = 0; i < LAMP_BUFFERS; i++)
        if (!make_buffer(p, i, bytes_of(p, t, i))) return false;
    return true;
}

static bool run_lists(pass *p, lamps_kernel index, const tiling *t, uint32_t x, uint32_t y) {
    kernel *k = pass_use_provided(p, &pass_lamps_provider, index);
    if (!k) return false;
    kernel_set_int(k, N_width, (int32_t)t->width);
    kernel_set_int(k, N_height, (int32_t)t->height);
    kernel_set_int(k, N_lamp_count, (int32_t)p->lamps->count);
    kernel_set_int(k, N_lamp_words, (int32_t)t->words);
    kernel_set_int(k, N_lamp_tiles_across, (int32_t)t->across);
    return kernel_run(k, p->host->device, x, y, 1);
}

static bool lamps_prepare(pass *p) {
    if (!p->lamps) return true;
    const tiling t = tiling_of(p);
    uint32_t x = (t.across + GROUP - 1) / GROUP * GROUP, rows = (p->lamps->count + x - 1) / x;
    lamps_way way = p->lamps->way;
    if (way == LAMPS_TILES && rows < t.height) rows = t.height;
    return make_buffers(p, &t) && run_lists(p, LAMPS_RECORDS, &t, x, rows) &&
           (way != LAMPS_TILES || run_lists(p, LAMPS_MASKS, &t, t.across * t.words, t.down)) &&
           (way != LAMPS_VOLUMES || lamps_draw_volumes(p, t.width, t.height));
}

enum { LAMP_LIGHT = LAMP_BUFFERS, LAMP_SLOTS };
static const char *const slots[LAMP_SLOTS] = {"LampRecords", "LampMasks", "LampBounds",
                                              "LampLight"};

static bool lamps_bind(pass *p, int slot, gpu_binding *out) {
    if (!p->lamps) return false;
    out->sampler = GPU_NEAREST_CLAMP;
    if (slot == LAMP_LIGHT)
        out->image = p->lamps->light;
    else
        out->buffer = p->lamps->buffers[slot];
    return out->image || out->buffer;
}

const pass_provider pass_lamps_provider = {
    .slots = {slots, LAMP_SLOTS},
    .find = find_lamps,
    .defines = lamps_defines,
    .kernels = kernels,
    .kernel_count = LAMPS_KERNELS,
    .names = {names, COUNT_OF(names)},
    .uses = uses_lamps,
    .wants = wants_kernel,
    .target = lamps_target,
    .list_memory = lamps_list_memory,
    .prepare = lamps_prepare,
    .bind = lamps_bind,
    .destroy = lamps_destroy,
};
