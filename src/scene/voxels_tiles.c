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

size_t voxels_count_tiles(const cell_box *box) {
    const tile_range at = find_tiles(box);
    size_t count = box->size[0] > 0;
    for (int a = 0; a < 3; a++) count *= at.end[a] - at.low[a];
    return count;
}

// Of the tiles that are composed, those that a part meets, counted from the first of them.
static tile_range tiles_intersect(const tile_range *composed, const cell_box *part) {
    tile_range out = find_tiles(part);
    for (int a = 0; a < 3; a++) {
        uint32_t low = composed->low[a], end = composed->end[a];
        out.low[a] = (out.low[a] > low ? out.low[a] : low) - low;
        out.end[a] = out.end[a] < end ? (out.end[a] > low ? out.end[a] - low : 0) : end - low;
        if (part->size[0] == 0) out.end[a] = 0;
    }
    return out;
}

#define EACH_TILE(at, x, y, z)                                                                     \
    for (uint32_t z = (at)->low[2]; z < (at)->end[2]; z++)                                         \
        for (uint32_t y = (at)->low[1]; y < (at)->end[1]; y++)                                     \
            for (uint32_t x = (at)->low[0]; x < (at)->end[0]; x++)

static size_t tile_at(const uint32_t count[3], uint32_t x, uint32_t y, uint32_t z) {
    return x + count[0] * (y + (size_t)count[1] * z);
}

static void count_part(uint32_t *tiles, const tile_range *at, const uint32_t count[3]) {
    EACH_TILE(at, x, y, z) tiles[tile_at(count, x, y, z)]++;
}

// Before what is there: the last part comes first.
static void put_part(voxels_lists *l, size_t first, const tile_range *at, const uint32_t count[3],
                     uint32_t part) {
    EACH_TILE(at, x, y, z) l->items[--l->items[first + tile_at(count, x, y, z)]] = part;
}

void voxels_list_tiles(voxels *v, const cell_box *dirty) {
    const tile_range composed = find_tiles(dirty);
    struct voxel_head *head = &v->state->head;
    voxels_lists *l = &v->lists;
    const size_t first = l->count;
    size_t tiles = 1;
    for (int a = 0; a < 3; a++) tiles *= head->tiles.v[a] = composed.end[a] - composed.low[a];
    head->tiles.v[3] = (uint32_t)first;
    MEM_RESERVE(l->items, first + tiles + 1, l->capacity);
    memset(l->items + first, 0, (tiles + 1) * sizeof *l->items);
    for (uint32_t i = 0; i < v->part_count; i++) {
        const tile_range at = tiles_intersect(&composed, &v->parts[i].box);
        count_part(l->items + first, &at, head->tiles.v);
    }
    l->count += tiles + 1;
    for (size_t i = first; i <= first + tiles;
         i++) { // of each the end until it is filled; the last is empty
        l->count += l->items[i];
        l->items[i] = (uint32_t)l->count;
    }
    MEM_RESERVE(l->items, l->count, l->capacity);
    for (uint32_t i = (uint32_t)v->part_count; i-- > 0;) {
        const tile_range at = tiles_intersect(&composed, &v->parts[i].box);
        put_part(l, first, &at, head->tiles.v, i);
    }
}
