// Parts by tiles of cells, VOXEL_ROW along each side: so a row of cells is composed from the parts
// that are near to it, however many there are. Two passes, as of a counting sort.
#include "base/memory.h"
#include "scene/voxels_impl.h"
#include <string.h>

typedef struct tile_range {
    uint32_t low[3], end[3]; // of tiles; nothing where they are the same
} tile_range;

static tile_range find_tiles(const cell_box *box) {
    tile_range out;
    for (int a = 0; a < 3; a++) {
        out.low[a] = box->low[a] / VOXEL_ROW;
        out.end[a] = (box->low[a] + box->size[a] + VOXEL_ROW - 1) / VOXEL_ROW;
    }
    return out;
}

// Of the tiles that are composed, those that a part meets, counted from the first of them.
static tile_range meet(const tile_range *composed, const cell_box *part) {
    tile_range out = find_tiles(part);
    for (int a = 0; a < 3; a++) {
        uint32_t low = composed->low[a], end = composed->end[a];
        out.low[a] = (out.low[a] > low ? out.low[a] : low) - low;
        out.end[a] = out.end[a] < end ? (out.end[a] > low ? out.end[a] - low : 0) : end - low;
        if (part->size[0] == 0) out.end[a] = 0;
    }
    return out;
}

// Counts a part in its tiles; or, the last part first, puts it before what is there.
static void add_part(uint32_t *list, const tile_range *at, const uint32_t count[3],
                     const uint32_t *part) {
    for (uint32_t z = at->low[2]; z < at->end[2]; z++)
        for (uint32_t y = at->low[1]; y < at->end[1]; y++)
            for (uint32_t x = at->low[0]; x < at->end[0]; x++) {
                uint32_t *tile = &list[x + count[0] * (y + (size_t)count[1] * z)];
                if (part)
                    list[--*tile] = *part;
                else
                    ++*tile;
            }
}

void voxels_list_tiles(voxels *v, const cell_box *dirty, uint32_t count[3]) {
    const tile_range composed = find_tiles(dirty);
    voxels_tiles *t = &v->tiles;
    for (int a = 0; a < 3; a++) count[a] = composed.end[a] - composed.low[a];
    const size_t tiles = (size_t)count[0] * count[1] * count[2];
    MEM_RESERVE(t->list, tiles + 1, t->capacity);
    memset(t->list, 0, (tiles + 1) * sizeof *t->list);
    for (size_t i = 0; i < v->part_count; i++) {
        const tile_range at = meet(&composed, &v->parts[i].box);
        add_part(t->list, &at, count, NULL);
    }
    t->count = tiles + 1;
    for (size_t i = 0; i <= tiles; i++) { // of each the end, for now; the last has no parts
        t->count += t->list[i];
        t->list[i] = (uint32_t)t->count;
    }
    MEM_RESERVE(t->list, t->count, t->capacity);
    for (uint32_t i = (uint32_t)v->part_count; i-- > 0;) {
        const tile_range at = meet(&composed, &v->parts[i].box);
        add_part(t->list, &at, count, &i);
    }
}
