// Pairs of a key and a splat, sorted on the device: by as many digits as tiles and depth need.
#include "base/swap.h"
#include "pass/particles/splats_parts.h"

enum {
    DIGIT_BITS = 4,
    ITEMS = 16, // of a thread, as in splats/sort.comp
    KEY_BITS = 32,
    DEPTH_BITS = 16, // unless tiles need more of the key
};

static uint32_t group_threads(const pass *p) {
    return gpu_get_profile(p->host->device)->sort_threads;
}

void splats_define_sort(pass *p, pass_defines *out) {
    pass_define(out, "SORT_THREADS", arena_format(p->host->memory, "%uu", group_threads(p)));
}

static uint32_t block_count(const pass *p) {
    uint32_t each = ITEMS * group_threads(p);
    return (splats_entries(p) + each - 1) / each;
}

void splats_find_sort_sizes(const pass *p, uint64_t out[SPLATS_BUFFERS]) {
    out[SPLATS_PAIRS] = out[SPLATS_SORTED] = 8ull * splats_entries(p);
    out[SPLATS_SORT_COUNTS] = (4ull << DIGIT_BITS) * block_count(p);
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

bool splats_sort(pass *p) {
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
