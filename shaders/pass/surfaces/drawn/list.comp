// A thread for each instance and view: puts it into the list, behind those of its bucket that come
// before it.
#include "drawn.glsl"
layout(std430) readonly buffer DrawnChoices { uint choices[]; };
layout(std430) readonly buffer DrawnFirsts { uint firsts[]; };
layout(std430) writeonly buffer InstanceList { uint list[]; };

void main() {
    uint index = gl_GlobalInvocationID.x, view = gl_GlobalInvocationID.y;
    if (index >= instance_count) return;
    uint all = view * instance_count, bucket = choices[all + index], block = index / DRAWN_BLOCK;
    if (bucket == DRAWN_NONE) return;
    uint at = firsts[block_at(view, bucket, block)];
    for (uint i = block * DRAWN_BLOCK; i < index; i++) at += uint(choices[all + i] == bucket);
    list[at] = index;
}
