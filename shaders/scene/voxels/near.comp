// Which triangle is nearest to the cells around it, for each item of all parts. Of the lines along
// the axis that the triangle faces most, only the cells near its plane are looked at.
#include "near.glsl"
layout(local_size_x = VOXEL_GROUP) in;
layout(std430) buffer VoxelKeys { uint voxel_keys[]; };

uvec3 turn_back(uvec3 v, uint axis) {
    return axis == 0u ? v.zxy : axis == 1u ? v.xzy : v;
}

void main() {
    uint number = uint(VOXEL_GROUP) * voxel_group() + gl_LocalInvocationID.x;
    if (number >= voxel.grid.w) return;
    near_triangle t = near_get(number);
    uint bits = near_bits();
    float reach = near_reach(), steps = float((1u << (32u - bits)) - 2u) / reach;
    vec3 normal = cross(t.b - t.a, t.c - t.a), steep = abs(normal);
    uint axis = steep.x > steep.y && steep.x > steep.z ? 0u : steep.y > steep.z ? 1u : 2u;
    uvec3 order = axis == 0u ? uvec3(1u, 2u, 0u) : axis == 1u ? uvec3(0u, 2u, 1u) : uvec3(0u, 1u, 2u);
    vec3 low = (min(min(t.a, t.b), t.c) - reach) / voxel.cell.xyz;
    vec3 high = (max(max(t.a, t.b), t.c) + reach) / voxel.cell.xyz;
    ivec3 first = max(ivec3(floor(low)), ivec3(0));
    ivec3 last = min(ivec3(floor(high)), ivec3(voxel.grid.xyz) - 1);
    uint u = order.x, v = order.y, w = order.z;
    // How far the plane can be along the axis, of what is near; of no plane: as far as the box goes.
    float facing = steep[w] / length(normal);
    bool flat_ = facing > 0.0;
    float along = flat_ ? reach / facing / voxel.cell[w] + 1.0 : 0.0;
    for (int y = first[v] + int(t.flags & 63u); y <= last[v]; y += int((t.flags >> 6) & 63u) + 1) {
        for (int x = first[u]; x <= last[u]; x++) {
            ivec2 range = ivec2(first[w], last[w]);
            if (flat_) {
                float du = (float(x) + 0.5) * voxel.cell[u] - t.a[u];
                float dv = (float(y) + 0.5) * voxel.cell[v] - t.a[v];
                float middle =
                    (t.a[w] - (normal[u] * du + normal[v] * dv) / normal[w]) / voxel.cell[w];
                range.x = max(range.x, int(floor(middle - along)));
                range.y = min(range.y, int(floor(middle + along)));
            }
            for (int z = range.x; z <= range.y; z++) {
                uvec3 cell = turn_back(uvec3(x, y, z), axis);
                vec3 p = near_centre(cell);
                float far = distance(p, near_point(t, p));
                if (far > reach) continue;
                atomicMin(voxel_keys[near_index(cell)], uint(far * steps) << bits | number);
            }
        }
    }
}
