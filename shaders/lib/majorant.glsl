// Bounds of the extinction, cell by cell over the box of the density, and rays through them
// (Amanatides and Woo, "A fast voxel traversal algorithm", 1987). reference_majorants.comp fills
// them.
uniform image3D majorants;           //= output r32f : in each cell of the box, the extinction that is looked out for (1/m)
uniform sampler3D majorants_before;  //= input history majorants : the same, as of the execution before
uniform float majorant_scale;        //= 1.2 [0.01, 100] : factor of the extinction that is looked out for: too low is noisy, too high is slow, neither is wrong
uniform vec3 box_min;
uniform vec3 box_max;
uniform int executed; // executions since the picture began, without this one

#ifndef LIB_MAJORANT_GLSL
#define LIB_MAJORANT_GLSL
#include "lib/box.glsl"

struct majorant_walk {
    vec3 origin, direction;
    float at, end; // metres along the ray
    ivec3 cell;
    vec3 next; // where the ray leaves the cell along each axis
};

majorant_walk majorant_begin(vec3 origin, vec3 direction, float end) {
    vec2 range = box_range(origin, direction, box_min, box_max);
    ivec3 count = imageSize(majorants);
    vec3 size = (box_max - box_min) / vec3(count);
    majorant_walk w;
    w.origin = origin;
    w.direction = direction;
    w.at = range.x;
    w.end = min(range.y, end);
    if (w.at >= w.end) return w;
    w.cell = clamp(ivec3(floor((origin + range.x * direction - box_min) / size)), ivec3(0), count - 1);
    vec3 border = box_min + (vec3(w.cell) + step(0.0, direction)) * size;
    w.next = (border - origin) / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    return w;
}

// Goes on by an optical depth; false: the ray ends before. `majorant` is that of where it stops.
bool majorant_go(inout majorant_walk w, float depth, out float majorant) {
    majorant = 0.0;
    ivec3 count = imageSize(majorants);
    ivec3 side = ivec3(step(0.0, w.direction)) * 2 - 1;
    vec3 width = (box_max - box_min) / (vec3(count) * max(abs(w.direction), 1e-20));
    for (int i = 0; i < count.x + count.y + count.z && w.at < w.end; i++) {
        float here = majorant_scale * imageLoad(majorants, w.cell).r;
        float leave = max(min(min(w.next.x, min(w.next.y, w.next.z)), w.end), w.at);
        float room = (leave - w.at) * here;
        if (depth < room) {
            w.at += depth / here;
            majorant = here;
            return true;
        }
        depth -= room;
        w.at = leave;
        int axis = w.next.x <= w.next.y && w.next.x <= w.next.z ? 0 : w.next.y <= w.next.z ? 1 : 2;
        w.next[axis] += width[axis];
        w.cell[axis] += side[axis];
        if (w.cell[axis] < 0 || w.cell[axis] >= count[axis]) break;
    }
    w.at = w.end;
    return false;
}

#endif
