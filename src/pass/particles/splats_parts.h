// The inside of the pass type `splats`, for its own files only.
#pragma once
#include "pass/pass_impl.h"

enum {
    SPLATS_TILE = 16,              // pixels along a tile
    SPLATS_GROUP = 256,            // threads of a group that has one for each particle
    SPLATS_RECORD = 48,            // bytes of a splat that is kept
    SPLATS_MOST_RECORDS = 1 << 20, // kept, where others are drawn by themselves,
    SPLATS_MOST_SORTED = 2097152,  // and where none is
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
enum { SPLATS_NAMES(KERNEL_NAME_ID) };

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

// splats.c
uint32_t splats_entries(const pass *p);    // places in the lists
uint32_t splats_tile_count(const pass *p); // as of the picture's size

// splats_sort.c: of blend = "sorted"
void splats_define_sort(pass *p, pass_defines *out);
void splats_find_sort_sizes(const pass *p, uint64_t out[SPLATS_BUFFERS]); // bytes
uint32_t splats_depth_bits(const pass *p); // of a key; the others say which tile
bool splats_sort(pass *p);                 // the pairs
