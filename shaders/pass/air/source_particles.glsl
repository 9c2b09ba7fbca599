// Particles that a source is near, for the shaders of sources. They are as in the middle of a step of the
// air. First a thread for each particle marks the cells that it passes in the step within its radius; then
// the source's fields are evaluated for each cell as of the particle whose way is nearest.
uniform sampler2D particles; //= input optional : the source is near these (of the pass particles), as long as they live; its fields may use particle_age and the like, which are those of the nearest
//@ field float radius = 0.1 : how far around its way a particle gives (m): at least to the cell that it is in, at most over 8 cells; 0 or less: it gives nothing
#if HAS_PARTICLES
#include "lib/particles_read.glsl"
uniform float step_seconds; // of the effect's time that a step of the air takes
uniform float time_scale;   // seconds of the air in one of the effect's
layout(std430) buffer SourceMarks { uint source_marks[]; }; // of each cell; 0: no particle is near

const uint MARK_SLOT = 0x00ffffffu; // the slot, turned round; above it 255 where the way passes, less far from it
#endif

// Whether a cell of the source's box is near a particle, if there must be one, and how that moves as the air counts.
bool source_is_near(uint cell, out vec3 moves) {
    moves = vec3(0.0);
#if HAS_PARTICLES
    particle near;
    uint mark = source_marks[cell];
    if (mark == 0u || !particle_read(~mark & MARK_SLOT, near)) return false;
    particle_say(near);
    moves = velocity_factor / time_scale * near.velocity;
#endif
    return true;
}

#if defined(STAGE_MARK)
layout(local_size_x = 256) in;
const float CELLS = 8.0; // that it reaches, and that it goes in a step, at most

void main() {
    uint slot = 256u * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    particle p;
    if (slot >= particle_used || !particle_read(slot, p)) return;
    particle_say(p);
    float radius = field_radius(p.position);
    if (!(radius > 0.0)) return;
    float reach = clamp(radius / cell_size, 0.867, CELLS); // half the diagonal of a cell
    vec3 way = step_seconds / cell_size * p.velocity;
    way *= min(1.0, CELLS * inversesqrt(max(dot(way, way), 1e-20)));
    vec3 from = (p.position - box_min) / cell_size - first - 0.5 - 0.5 * way; // it is in the middle of its way
    vec3 low = min(from, from + way) - reach, high = max(from, from + way) + reach;
    if (!(all(greaterThanEqual(high, vec3(0.0))) && all(lessThan(low, count)))) return;
    ivec3 begin = ivec3(ceil(max(low, 0.0))), end = ivec3(min(high, count - 1.0));
    for (int z = begin.z; z <= end.z; z++)
        for (int y = begin.y; y <= end.y; y++)
            for (int x = begin.x; x <= end.x; x++) {
                vec3 to = vec3(x, y, z) - from;
                float away = length(to - clamp(dot(to, way) / max(dot(way, way), 1e-12), 0.0, 1.0) * way) / reach;
                if (away > 1.0) continue;
                uint cell = uint(x) + uint(count.x) * (uint(y) + uint(count.y) * uint(z));
                atomicMax(source_marks[cell], uint(255.0 - 254.0 * away) << 24 | (~slot & MARK_SLOT));
            }
}
#endif
