// A thread for each instance and view: which bucket it is drawn from, if it can be seen.
#include "drawn.glsl"
#include "lib/level.glsl"
#include "lib/turn.glsl"
layout(std430) readonly buffer Views { view_entry views[]; };
layout(std430) readonly buffer Instances { instance_entry instances[]; };
layout(std430) readonly buffer DrawnBuckets { drawn_bucket buckets[]; };
layout(std430) writeonly buffer DrawnChoices { uint choices[]; };
layout(std430) buffer DrawnTotals { uint totals[]; };
layout(std430) buffer DrawnCounts { uint counts[]; };
uniform mat4 place;  // of all instances, to the world
uniform float scale; // of that
uniform float lod;   // pixels that a simplified mesh may be off
uniform float most;  // from the eye to the middle of what is shown at all (m); 0: however far

// Rounding of places and planes is less by far, and this more by far than could be left out.
const float SLACK = 1.0 / 16384.0;

// Planes of a view, after Gribb and Hartmann 2001 ("Fast Extraction of Viewing Frustum Planes from
// the World-View-Projection Matrix"), with depths from 0 on; they need no length of 1.
bool is_outside(vec4 plane, vec3 centre, float radius) {
    return dot(plane, vec4(centre, 1.0)) < -radius * length(plane.xyz);
}

bool is_seen(mat4 clip, vec3 centre, float radius) {
    mat4 rows = transpose(clip);
    float r = radius + SLACK * (radius + length(centre));
    return clip != mat4(0.0) && !is_outside(rows[3] + rows[0], centre, r) && !is_outside(rows[3] - rows[0], centre, r) &&
           !is_outside(rows[3] + rows[1], centre, r) && !is_outside(rows[3] - rows[1], centre, r) &&
           !is_outside(rows[2], centre, r) && !is_outside(rows[3] - rows[2], centre, r);
}

uint bucket_of(instance_entry entry, view_entry view) {
    uint first = entry.kind.x * DRAWN_LEVELS;
    float size = abs(entry.place.w) * scale;
    if (entry.kind.x == INSTANCE_HIDDEN || first >= bucket_count || size == 0.0) return DRAWN_NONE;
    vec4 sphere = buckets[first].sphere;
    vec3 within = turn_vector(entry.turn, sphere.xyz) * entry.place.w + entry.place.xyz;
    vec3 centre = (place * vec4(within, 1.0)).xyz;
    if (most > 0.0 && distance(centre, view.eye.xyz) > most) return DRAWN_NONE;
    if (!is_seen(view.clip, centre, sphere.w * size)) return DRAWN_NONE;
    vec4 errors = vec4(0.0);
    for (uint i = 1u; i < DRAWN_LEVELS; i++) errors[i] = uintBitsToFloat(buckets[first + i].draws.z) * size;
    return first + level_of(errors, view.eye.w, lod, distance(centre, view.eye.xyz), sphere.w * size);
}

void main() {
    uint index = gl_GlobalInvocationID.x, view = gl_GlobalInvocationID.y;
    if (index >= instance_count) return;
    uint bucket = bucket_of(instances[index], views[view]);
    choices[view * instance_count + index] = bucket;
    if (bucket == DRAWN_NONE) return;
    atomicAdd(totals[bucket_at(view, bucket)], 1u);
    atomicAdd(counts[block_at(view, bucket, index / DRAWN_BLOCK)], 1u);
}
