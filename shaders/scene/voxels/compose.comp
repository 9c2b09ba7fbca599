// Last of three dispatches: the ids of a row of cells, of the later part where several hold one.
layout(local_size_x = 8, local_size_y = 16, local_size_z = 2) in;
#include "inside.glsl"
layout(std430) writeonly buffer VoxelIds { uvec4 voxel_ids4[]; };

const uint fours = uint(VOXEL_ROW) / 4u;

uint find_tile(uvec3 at) {
    uvec3 tile = at / uint(VOXEL_ROW) - voxel.low.xyz / uint(VOXEL_ROW);
    return voxel.tiles.w + tile.x + voxel.tiles.x * (tile.y + voxel.tiles.y * tile.z);
}

void main() {
    uvec3 at = gl_GlobalInvocationID * uvec3(VOXEL_ROW, 1, 1);
    if (any(greaterThanEqual(at, voxel.size.xyz))) return;
    uint count = min(fours, (voxel.size.x - at.x) / 4u);
    at += voxel.low.xyz;
    uvec4 ids[fours];
    for (uint k = 0u; k < fours; k++) ids[k] = uvec4(0u);
    const uint tile = find_tile(at), past = voxel_lists[tile + 1u];
    for (uint next = voxel_lists[tile]; next < past; next++) {
        uint i = voxel_lists[next];
        uvec3 low = voxel_parts[i].low.xyz, end = low + voxel_parts[i].size.xyz;
        if (at.x + 4u * count <= low.x || at.x >= end.x || any(lessThan(at.yz, low.yz)) ||
            any(greaterThanEqual(at.yz, end.yz)))
            continue;
        voxel_part p = voxel_parts[i];
        voxel_masks m = voxel_find_masks(p);
        for (uint k = 0u; k < fours; k++) {
            uvec3 cell = at + uvec3(4u * k, 0u, 0u);
            if (!voxel_enter(p, cell)) continue;
            uvec4 inside = voxel_solid(m, cell);
            if (p.size.w != 0u) inside |= voxel_shell(m, cell);
            ids[k] = mix(ids[k], uvec4(p.low.w), notEqual(inside, uvec4(0u)));
        }
    }
    uint word = at.x / 4u + voxel.grid.x / 4u * (at.y + voxel.grid.y * at.z);
    for (uint k = 0u; k < count; k++) voxel_ids4[word + k] = ids[k];
}
