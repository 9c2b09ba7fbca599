// The lists of the tiles: first where each begins, from how many entries it will have; then what is
// in them. In which order is left to chance: it is added up in whole numbers.
#if defined(STAGE_SCAN) && BLEND != BLEND_SORTED
void main() {
    uint total = tiles_across * tiles_down, each = (total + SCANNERS - 1u) / SCANNERS;
    uint first = gl_LocalInvocationIndex * each, end = min(first + each, total), sum = 0u;
    for (uint i = first; i < end; i++) sum += splat_tiles[i].y;
    uint at = scan_before(sum);
    for (uint i = first; i < end; i++) {
        uint count = splat_tiles[i].y;
        splat_tiles[i] = uvec2(at); // its end goes on as the list is filled
        at += count;
    }
}
#endif

#if defined(STAGE_LIST) && BLEND != BLEND_SORTED
void main() {
    uint index = slot_of_thread();
    if (index >= min(splat_found, records_most)) return;
    splat s = splat_kept(index);
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++) {
            if (!splat_meets(s, ivec2(x, y))) continue;
            uint place = atomicAdd(splat_tiles[splat_tile(ivec2(x, y))].y, 1u);
            if (place < entries_most) {
                splat_entries[place] = index;
            } else {
                splat_add_tile(s, ivec2(x, y));
                count_left_out(1);
            }
        }
}
#endif
