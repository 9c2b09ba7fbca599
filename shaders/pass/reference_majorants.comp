// The bounds that paths of `reference` go by: the greatest extinction at random points of each cell
// and of half its neighbours, so that it does not end with the cell. Every execution adds points.
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
#include "lib/medium.glsl"
#include "lib/majorant.glsl"
#include "lib/path.glsl"

// Where the medium glows, light is collected at collisions: there must be some, however thin it is.
const float GLOWING = 0.5; // collisions a cell

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID), count = imageSize(majorants);
    if (any(greaterThanEqual(cell, count))) return;
    vec3 size = (box_max - box_min) / vec3(count), most = medium_extinction();
    float highest = max(most.r, max(most.g, most.b));
    float glowing = GLOWING / max(size.x, max(size.y, size.z));
    float found = executed > 0 ? texelFetch(majorants_before, cell, 0).r : 0.0;
    int side = executed > 0 ? 2 : 4;
    for (int i = 0; i < side * side * side; i++) {
        vec3 part = vec3(i % side, i / side % side, i / (side * side));
        path_random random = path_random(uvec3(cell), uint(executed * 64 + i));
        vec3 p = box_min + (vec3(cell) - 0.5 + 2.0 * (part + path_next(random).xyz) / float(side)) * size;
        float d = medium_density(p);
        if (d <= 0.0) continue;
        found = max(found, d * highest);
        if (any(greaterThan(medium_emission(p, d), vec3(0.0)))) found = max(found, glowing);
    }
    imageStore(majorants, cell, vec4(found));
}
