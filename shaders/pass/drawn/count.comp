// A thread for each bucket and view: where in the list of its view each of its blocks begins, and
// how many instances its commands draw.
#include "drawn.glsl"
layout(std430) readonly buffer DrawnBuckets { drawn_bucket buckets[]; };
layout(std430) readonly buffer DrawnTotals { uint totals[]; };
layout(std430) readonly buffer DrawnCounts { uint counts[]; };
layout(std430) writeonly buffer DrawnFirsts { uint firsts[]; };
layout(std430) writeonly buffer DrawnCommands { uint commands[]; }; // gpu_draw_indexed_command
uniform uint command_count; // of a view

void main() {
    uint bucket = gl_GlobalInvocationID.x, view = gl_GlobalInvocationID.y;
    if (bucket >= bucket_count) return;
    uint first = view * instance_count;
    for (uint i = 0u; i < bucket; i++) first += totals[bucket_at(view, i)];
    uint at = first;
    for (uint i = 0u; i < block_count; i++) {
        uint block = block_at(view, bucket, i), count = counts[block];
        firsts[block] = at;
        at += count;
    }
    uvec4 draws = buckets[bucket].draws;
    for (uint i = 0u; i < draws.y; i++) {
        uint command = 5u * (view * command_count + draws.x + i * draws.w);
        commands[command + 1u] = at - first;
        commands[command + 4u] = first;
    }
}
