// Triangles of all parts by one number each, and how far a point is from one.
#include "state.glsl"
layout(std430) readonly buffer VoxelItems { uvec4 voxel_items[]; };
layout(std430) readonly buffer VoxelPlaced { ivec4 voxel_placed[]; };

// Around a triangle within so many cells it is found exactly which one is nearest (src/scene/voxels.h).
const float near_cells = 3.0;

// A key is a distance, in 32 - near_bits() bits, above the number of a triangle.
uint near_bits() {
    return uint(findMSB(max(voxel.grid.w, 1u))) + 1u;
}
float near_reach() { // metres
    return near_cells * max(voxel.cell.x, max(voxel.cell.y, voxel.cell.z));
}

struct near_triangle { // metres, from the corner of the box
    vec3 a, b, c;
    uint flags; // of its item
};

near_triangle near_get(uint number) {
    uint low = 0u, high = voxel.count.x;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (voxel_parts[middle].place.w <= number) low = middle;
        else high = middle;
    }
    uvec4 item = voxel_items[voxel_parts[low].mesh.z + number - voxel_parts[low].place.w];
    uint first = voxel_parts[low].place.x;
    vec3 scale = voxel.cell.xyz / float(VOXEL_UNIT);
    return near_triangle(scale * vec3(voxel_placed[first + item.x].xyz),
                         scale * vec3(voxel_placed[first + item.y].xyz),
                         scale * vec3(voxel_placed[first + item.z].xyz), item.w);
}

// The point of a triangle that is nearest to p: Ericson, "Real-time collision detection", 5.1.5.
vec3 near_point(near_triangle t, vec3 p) {
    vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
    float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return t.a;
    vec3 bp = p - t.b;
    float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return t.b;
    float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return t.a + d1 / (d1 - d3) * ab;
    vec3 cp = p - t.c;
    float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return t.c;
    float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return t.a + d2 / (d2 - d6) * ac;
    float va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 >= d3 && d5 >= d6)
        return t.b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t.c - t.b);
    float all = 1.0 / (va + vb + vc);
    return t.a + vb * all * ab + vc * all * ac;
}

uint near_index(uvec3 cell) {
    return cell.x + voxel.grid.x * (cell.y + voxel.grid.y * cell.z);
}
vec3 near_centre(uvec3 cell) {
    return (vec3(cell) + 0.5) * voxel.cell.xyz;
}
