// Puts the splats into the lists of their tiles. In which order is left to chance: they are added up
// in whole numbers.
#if defined(STAGE_LIST)
layout(local_size_x = 256) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= min(splat_found, records_most)) return;
    splat s = splat_kept(index);
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++) {
            if (!splat_meets(s, ivec2(x, y))) continue;
            uint place = atomicAdd(splat_tiles[splat_tile(ivec2(x, y))].y, 1u);
            if (place < entries_most)
                splat_entries[place] = index;
            else
                splat_add_tile(s, ivec2(x, y));
        }
}
#endif
