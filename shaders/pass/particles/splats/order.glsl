// Blend sorted: every splat is kept under the number of its slot, and pairs of tile with depth, and
// slot, are written one after the other in the order of slots: where two are equally near, that order
// stays. Sorted by splats/sort.comp, they are the tiles' lists, nearest first.
#if BLEND == BLEND_SORTED
layout(std430) buffer SplatCounts { uint splat_counts[]; }; // of each slot: tiles that it touches
layout(std430) buffer SplatGroups { uint splat_groups[]; }; // of each group of slots
layout(std430) buffer SplatPairs { uvec2 splat_pairs[]; };
uniform uint depth_bits; // of the key, the lowest
uniform uint group_count;

uint tiles_met(splat s) {
    ivec4 box = splat_tile_box(s);
    uint count = 0u;
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++) count += uint(splat_meets(s, ivec2(x, y)));
    return count;
}
#endif

#if defined(STAGE_PROJECT) && BLEND == BLEND_SORTED
shared uint group_sum;

void main() {
    uint slot = slot_of_thread();
    looks l = look_at(slot);
    if (gl_LocalInvocationIndex == 0u) group_sum = 0u;
    barrier();
    uint count = 0u;
    if (l.seen) {
        count_large(1);
        splat s = look_spread(l);
        count = tiles_met(s);
        splat_keep(slot, s);
    }
    if (slot < particle_used) splat_counts[slot] = count;
    atomicAdd(group_sum, count);
    barrier();
    if (gl_LocalInvocationIndex == 0u) splat_groups[group_of_thread()] = group_sum;
}
#endif

#if defined(STAGE_SCAN) && BLEND == BLEND_SORTED
void main() {
    uint each = (group_count + SCANNERS - 1u) / SCANNERS;
    uint first = gl_LocalInvocationIndex * each, end = min(first + each, group_count), sum = 0u;
    for (uint i = first; i < end; i++) sum += splat_groups[i];
    uint at = scan_before(sum);
    for (uint i = first; i < end; i++) {
        uint count = splat_groups[i];
        splat_groups[i] = at;
        at += count;
    }
    if (gl_LocalInvocationIndex == SCANNERS - 1u) splat_listed = at;
}
#endif

#if defined(STAGE_LIST) && BLEND == BLEND_SORTED
uint key_of(uint tile, float away) {
    float part = log2(away / frame.lens.z) / log2(frame.lens.w / frame.lens.z);
    return tile << depth_bits | uint(clamp(part, 0.0, 1.0) * float((1u << depth_bits) - 1u));
}

void main() {
    uint slot = slot_of_thread(), count = slot < particle_used ? splat_counts[slot] : 0u;
    uint at = scan_before(count) + splat_groups[group_of_thread()];
    if (count == 0u) return;
    splat s = splat_kept(slot);
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++) {
            if (!splat_meets(s, ivec2(x, y))) continue;
            if (at < entries_most)
                splat_pairs[at] = uvec2(key_of(splat_tile(ivec2(x, y)), s.depth), slot);
            else
                count_left_out(1);
            at++;
        }
}
#endif

#if defined(STAGE_BOUNDS)
layout(local_size_x = 256) in;

void main() {
    uint at = gl_WorkGroupID.y * gl_NumWorkGroups.x * 256u + gl_GlobalInvocationID.x;
    uint count = min(splat_listed, entries_most);
    if (at >= count) return;
    uint tile = splat_pairs[at].x >> depth_bits;
    if (at == 0u || splat_pairs[at - 1u].x >> depth_bits != tile) splat_tiles[tile].x = at;
    if (at + 1u == count || splat_pairs[at + 1u].x >> depth_bits != tile) splat_tiles[tile].y = at + 1u;
}
#endif
