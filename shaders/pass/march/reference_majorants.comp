// The bounds that paths of `reference` go by: the greatest extinction at random points of each cell,
// where every execution adds points, but no less than a part of what the range of the density allows
// (all of it is mostly more than there is). So the bound is above 0 wherever the density may be, and
// no feature is passed unseen, however small. Of a density whose range is not known points of half
// the neighbours count, too, so that it does not end with the cell.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
#define WITH_RANGES
#include "lib/medium.glsl"
#include "lib/majorant.glsl"
#include "lib/path.glsl"

// Where the medium glows, light is collected at collisions: there must be some, however thin it is.
const float GLOWING = 0.5; // collisions a cell
const float PART = 0.25;   // of the greatest extinction that the range allows

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID), count = imageSize(majorants);
    if (any(greaterThanEqual(cell, count))) return;
    range_width = 0.0; // of paths: grids as fine as they are
    vec3 size = (box_max - box_min) / vec3(count), most = medium_extinction();
    float highest = max(most.r, max(most.g, most.b));
    float glowing = GLOWING / max(size.x, max(size.y, size.z));
    vec3 low = box_min + vec3(cell) * size, rounding = 1e-4 * size + 1e-6 * abs(low);
    vec2 range = field_density_range(low - rounding, low + size + rounding);
    bool known = range.y < RANGE_MOST;
    float found = executed > 0 ? texelFetch(majorants_before, cell, 0).r : 0.0;
    if (known) found = max(found, PART * range.y * highest);
    int side = range.y <= 0.0 ? 0 : executed > 0 ? 2 : 4;
    float beside = known ? 0.0 : 0.5;
    for (int i = 0; i < side * side * side; i++) {
        vec3 part = vec3(i % side, i / side % side, i / (side * side));
        path_random random = path_random(uvec3(cell), uint(executed * 64 + i));
        part = (part + path_next(random).xyz) / float(side);
        vec3 p = box_min + (vec3(cell) + mix(vec3(-beside), vec3(1.0 + beside), part)) * size;
        float d = medium_density(p);
        if (d <= 0.0) continue;
        found = max(found, d * highest);
        if (any(greaterThan(medium_emission(p, d), vec3(0.0)))) found = max(found, glowing);
    }
    imageStore(majorants, cell, vec4(found));
}
