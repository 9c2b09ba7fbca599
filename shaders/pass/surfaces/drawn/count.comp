// A thread for each bucket and view: where in the list of its view each of its blocks begins, and
// how many instances its commands draw.
#include "drawn.glsl"
layout(std430) readonly buffer DrawnBuckets { drawn_bucket buckets[]; };
layout(std430) readonly buffer DrawnTotals { uint totals[]; };
layout(std430) readonly buffer DrawnCounts { uint counts[]; };
layout(std430) writeonly buffer DrawnFirsts { uint firsts[]; };
layout(std430) writeonly buffer DrawnCommands { uint commands[]; }; // gpu_draw_indexed_command
uniform uint command_count; // of a view
const uint AT_ONCE = 8u; // blocks: a thread that waits for each by itself waits long

void main() {
    uint bucket = gl_GlobalInvocationID.x, view = gl_GlobalInvocationID.y;
    if (bucket >= bucket_count) return;
    uint first = view * instance_count;
    for (uint i = 0u; i < bucket; i++) first += totals[bucket_at(view, i)];
    uint at = first;
    for (uint i = 0u; i < block_count; i += AT_ONCE) {
        uint block = block_at(view, bucket, i), some[AT_ONCE];
        for (uint k = 0u; k < AT_ONCE; k++) some[k] = i + k < block_count ? counts[block + k] : 0u;
        for (uint k = 0u; k < AT_ONCE; k++) {
            if (i + k < block_count) firsts[block + k] = at;
            at += some[k];
        }
    }
    uvec4 draws = buckets[bucket].draws;
    for (uint i = 0u; i < draws.y; i++) {
        uint command = 5u * (view * command_count + draws.x + i * draws.w);
        commands[command + 1u] = at - first;
        commands[command + 4u] = WITHOUT_FIRST_INSTANCE != 0 ? 0u : first;
    }
}
