// Pairs of a key and a splat, sorted on the device: by as many digits as tiles and depth need.
#include "base/memory.h"
#include "pass/splats_parts.h"
#include <string.h>

enum {
    DIGIT_BITS = 4,
    ITEMS = 16,            // of a thread, as in splats/sort.comp
    THREADS = 256,         // of a group
    SOFTWARE_THREADS = 32, // where threads of a group take turns
    KEY_BITS = 32,
    DEPTH_BITS = 16, // unless tiles need more of the key
};

static const char shader[] = "pass/splats/sort.comp";
static const char *const stages[SPLATS_SORT_STAGES] = {"STAGE_SORT_COUNT", "STAGE_SORT_SCAN",
                                                       "STAGE_SORT_MOVE"};

static uint32_t group_threads(const pass *p) {
    const gpu *device = p->host->device;
    return device && gpu_get_info(device)->kind == GPU_CPU ? SOFTWARE_THREADS : THREADS;
}

bool splats_compile_sort(pass *p) {
    splats_state *s = splats_of(p);
    const char *threads = arena_format(p->host->memory, "%uu", group_threads(p));
    for (int i = 0; i < SPLATS_SORT_STAGES; i++) {
        const shader_define defines[] = {
            {stages[i], "1"}, {"SORT_THREADS", threads}, {"WITHOUT_FIELDS", "1"}};
        if (!pass_compile(p, shader, SHADER_COMPUTE, defines, COUNT_OF(defines),
                          &s->sort_binary[i]))
            return false;
    }
    return true;
}

bool splats_build_sort(pass *p) {
    splats_state *s = splats_of(p);
    if (!splats_compile_sort(p)) return false;
    for (int i = 0; i < SPLATS_SORT_STAGES; i++) {
        const shader_binary *binary = &s->sort_binary[i];
        s->sort_pipeline[i] = pass_create_compute(p, binary);
        s->sort_block[i] = arena_alloc(p->host->memory, pass_block_size(binary) + 16);
        if (!s->sort_pipeline[i]) return false;
    }
    return true;
}

static uint32_t block_count(const pass *p) {
    uint32_t each = ITEMS * group_threads(p);
    return (splats_entries(p) + each - 1) / each;
}

bool splats_make_sort(pass *p) {
    uint64_t pairs = 8ull * splats_entries(p), counts = (4ull << DIGIT_BITS) * block_count(p);
    return splats_make_buffer(p, SPLATS_PAIRS, pairs) &&
           splats_make_buffer(p, SPLATS_SORTED, pairs) &&
           splats_make_buffer(p, SPLATS_SORT_COUNTS, counts);
}

static uint32_t tile_bits(const pass *p) {
    uint32_t bits = 1;
    while (bits < KEY_BITS - 1 && (splats_tile_count(p) - 1) >> bits) bits++;
    return bits;
}

uint32_t splats_depth_bits(const pass *p) {
    uint32_t left = KEY_BITS - tile_bits(p);
    return left < DEPTH_BITS ? left : DEPTH_BITS;
}

static bool run(pass *p, splats_sort_stage stage, uint32_t threads) {
    splats_state *s = splats_of(p);
    const pass_override overrides[] = {
        {"SortFrom", {.buffer = s->buffers[SPLATS_PAIRS]}},
        {"SortTo", {.buffer = s->buffers[SPLATS_SORTED]}},
        {"SortCounts", {.buffer = s->buffers[SPLATS_SORT_COUNTS]}},
        {"SplatHead", {.buffer = s->buffers[SPLATS_HEAD]}},
    };
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = s->sort_pipeline[stage], .bindings = bindings, .threads = {threads, 1, 1}};
    return pass_bind(p, &s->sort_binary[stage], s->sort_block[stage], overrides,
                     COUNT_OF(overrides), bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool splats_sort(pass *p) {
    splats_state *s = splats_of(p);
    uint32_t threads = group_threads(p), bits = splats_depth_bits(p) + tile_bits(p);
    const uint32_t entries = splats_entries(p);
    for (uint32_t shift = 0; shift < bits; shift += DIGIT_BITS) {
        for (int i = 0; i < SPLATS_SORT_STAGES; i++) {
            const shader_binary *binary = &s->sort_binary[i];
            pass_write_member(binary, s->sort_block[i], "shift", &shift, sizeof shift);
            pass_write_member(binary, s->sort_block[i], "entries_most", &entries, sizeof entries);
        }
        if (!run(p, SPLATS_SORT_COUNT, threads * block_count(p)) ||
            !run(p, SPLATS_SORT_SCAN, threads) ||
            !run(p, SPLATS_SORT_MOVE, threads * block_count(p)))
            return false;
        gpu_buffer *sorted = s->buffers[SPLATS_SORTED];
        s->buffers[SPLATS_SORTED] = s->buffers[SPLATS_PAIRS];
        s->buffers[SPLATS_PAIRS] = sorted;
    }
    return true;
}
