// Particles as a volume: how much of the light that passes they take, in the cells of a box. With that beside the smoke, in the density of `lighting`, they cast shadows.
//
// Made by deposit { chaff, box = { min = {-1, -1, 0}, max = {1, 1, 2} } }. A particle is
// shared out to the eight cells around it, in whole numbers, so that sums are the same in any order.
//@ field float size = 0.02 : diameter (m), as of `splats`
//@ field float opacity = 1 : of its middle, as of `splats`
uniform float amount;              //= 1 [0, 1e6] : factor of what they take
uniform bool moving; // `velocity` is read
uniform vec3 cells;
uniform vec3 box_min;
uniform vec3 box_max;
writeonly uniform image3D density; //= output r16f : extinction (1/m)
writeonly uniform image3D velocity; //= output rgba16f optional : mean of the particles there (m/s)

#include "lib/frame.glsl"
#include "lib/random.glsl"
#include "lib/particles.glsl"
#include "lib/particle.glsl"
#include "fields.glsl"

// Of each cell, in parts of UNIT. Then, where they are read, of each cell its particles and their
// velocities, in parts of MOTION_UNIT; what is below 0 goes round, and sums come out right.
layout(std430) buffer DepositSums { uint deposit_sums[]; };
const float UNIT = 65536.0, MOST = 60000.0, MOTION_UNIT = 1024.0, FASTEST = 1000.0;

uint cell_number(ivec3 cell) {
    ivec3 size = ivec3(cells);
    return uint((cell.z * size.y + cell.y) * size.x + cell.x);
}

uint motion_number(ivec3 cell) {
    return uint(cells.x * cells.y * cells.z) + 4u * cell_number(cell);
}

#if defined(STAGE_ADD)
layout(local_size_x = 256) in;

// Square metres that it takes light from: a spot as `splats` draws it, (1 - r^2)^2.
float taken_by(particle p) {
    particle_say(p);
    float radius = 0.5 * max(field_size(p.position), 0.0);
    return 3.14159265 / 3.0 * radius * radius * clamp(field_opacity(p.position), 0.0, 1.0) * amount;
}

void main() {
    uint slot = 256u * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    particle p;
    if (slot >= particle_used || !particle_read(slot, p)) return;
    vec3 cell = (box_max - box_min) / cells, at = (p.position - box_min) / cell - 0.5;
    if (any(lessThan(at, vec3(-1.0))) || any(greaterThanEqual(at, cells))) return;
    float taken = min(taken_by(p) / (cell.x * cell.y * cell.z), MOST);
    if (!(taken > 0.0)) return;
    vec3 corner = floor(at), part = at - corner;
    uint seed = random_hash(floatBitsToUint(at.x) ^ random_hash(floatBitsToUint(at.y) ^ floatBitsToUint(at.z)));
    for (int i = 0; i < 8; i++) {
        ivec3 side = ivec3(i & 1, (i >> 1) & 1, i >> 2), to = ivec3(corner) + side;
        if (any(lessThan(to, ivec3(0))) || any(greaterThanEqual(to, ivec3(cells)))) continue;
        vec3 share = mix(1.0 - part, part, vec3(side));
        float chance = float(random_hash(seed + uint(i)) >> 8) / 16777216.0;
        float whole = share.x * share.y * share.z;
        atomicAdd(deposit_sums[cell_number(to)], uint(taken * whole * UNIT + chance));
        if (!moving) continue;
        ivec3 moved = ivec3(whole * clamp(p.velocity, -FASTEST, FASTEST) * MOTION_UNIT);
        atomicAdd(deposit_sums[motion_number(to)], uint(whole * MOTION_UNIT));
        for (int c = 0; c < 3; c++) atomicAdd(deposit_sums[motion_number(to) + uint(c + 1)], uint(moved[c]));
    }
}
#endif

#if defined(STAGE_SHOW)
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(cell, ivec3(cells)))) return;
    uint sum = deposit_sums[cell_number(cell)];
    deposit_sums[cell_number(cell)] = 0u; // for the next frame
    imageStore(density, cell, vec4(min(float(sum) / UNIT, MOST)));
    if (!moving) return;
    uint at = motion_number(cell);
    vec3 mean = vec3(0.0);
    float count = float(deposit_sums[at]);
    for (int c = 0; c < 3; c++) mean[c] = float(int(deposit_sums[at + uint(c + 1)])) / max(count, 1.0);
    for (uint c = 0u; c < 4u; c++) deposit_sums[at + c] = 0u;
    imageStore(velocity, cell, vec4(mean, 1.0));
}
#endif
