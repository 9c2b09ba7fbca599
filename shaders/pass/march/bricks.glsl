// Makes the bricks that the march skips by (lib/bricks.glsl), in two stages: what each brick may
// hold, and how far empty blocks lie from others.
layout(r32ui) uniform uimage3D bricks_kept;
uniform float brick_rows; // pixels of the march, from top to bottom

#if defined(STAGE_HOLD)
layout(local_size_x = 32, local_size_y = 4) in; // bricks of a block, blocks
shared uint held[4];

// Rays meet a brick a little outside of it, by their rounding.
const float BESIDE = 1.0 / 64.0, ROUNDED = 1e-6;

void main() {
    uint brick = gl_LocalInvocationID.x, row = gl_LocalInvocationID.y;
    ivec3 count = ivec3(brick_blocks);
    int index = int(gl_GlobalInvocationID.y);
    ivec3 block = ivec3(index % count.x, index / count.x % count.y, index / (count.x * count.y));
    if (brick == 0u) held[row] = 0u;
    barrier();
    if (brick < BRICKS_FREE && block.z < count.z) {
        vec3 size = (box_max - box_min) / (3.0 * brick_blocks);
        vec3 low = box_min + (3.0 * vec3(block) + vec3(brick % 3u, brick / 3u % 3u, brick / 9u)) * size;
        vec3 around = BESIDE * size + ROUNDED * (abs(low) + distance(frame.eye.xyz, low));
        range_width = 2.0 * frame.lens.y / brick_rows * (distance(frame.eye.xyz, low + 0.5 * size) + length(size));
        if (field_density_range(low - around, low + size + around).y > 0.0)
            atomicOr(held[row], 1u << brick);
    }
    barrier();
    if (brick == 0u && block.z < count.z) imageStore(bricks_kept, block, uvec4(held[row]));
}
#endif

#if defined(STAGE_FREE)
// A group makes a part of WIDE x 8 x 8 blocks. It sees REACH blocks farther, a bit each.
const int REACH = 4, WIDE = 32 - 2 * REACH, ROWS = 8 + 2 * REACH;
layout(local_size_x = ROWS, local_size_y = ROWS) in; // y, z
shared uint rows[ROWS][ROWS];

// At least as many blocks away, and `beyond` when there are none so near.
int free_blocks(int x, int y, int z) {
    uint near = 0u;
    for (int k = 1; k <= REACH; k++) {
        for (int i = -k; i <= k; i++)
            near |= rows[z - k][y + i] | rows[z + k][y + i] | rows[z + i][y - k] | rows[z + i][y + k];
        near |= k == 1 ? rows[z][y] : 0u;
        uint within = (2u << 2 * k) - 1u;
        if ((near & within << x - k) != 0u) return k;
    }
    return REACH + 1;
}

void main() {
    ivec3 count = ivec3(brick_blocks);
    ivec2 row = ivec2(gl_LocalInvocationID.xy);
    ivec3 first = ivec3(gl_WorkGroupID) * ivec3(WIDE, 8, 8);
    ivec2 at = first.yz + row - REACH;
    uint word = 0u;
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, count.yz)))
        for (int x = max(first.x - REACH, 0); x < min(first.x + WIDE + REACH, count.x); x++)
            if ((imageLoad(bricks_kept, ivec3(x, at)).r & BRICKS_HOLD) != 0u)
                word |= 1u << (x - first.x + REACH);
    rows[row.y][row.x] = word;
    barrier();
    int index = int(gl_LocalInvocationIndex);
    for (int i = index; i < WIDE * 64; i += ROWS * ROWS) {
        ivec3 part = ivec3(i % WIDE, i / WIDE % 8, i / (WIDE * 8)), block = first + part;
        ivec3 seen = part + REACH;
        if (any(greaterThanEqual(block, count)) || (rows[seen.z][seen.y] >> seen.x & 1u) != 0u) continue;
        uint away = uint(free_blocks(seen.x, seen.y, seen.z));
        imageStore(bricks_kept, block, uvec4(away << BRICKS_FREE));
    }
}
#endif
