// Birth of particles, before the step that it lies in: when, where and how fast. The host knows how
// many are born (src/pass/particles/particles_birth.c); all else is random by the particle's number. Apart
// from the step, since few are born in it, and software devices go through all of a branch.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
#define PARTICLES_ACCESS
#include "lib/particles_state.glsl"
#include "fields.glsl"
#include "put.glsl"
// Those of pass/particles/particles.comp:
uniform float lifetime_min;
uniform float lifetime_max;
uniform float threshold;
uniform vec3 position;
uniform float radius;
uniform float outward;
uniform float spread;
uniform float variation;
uniform float inherit;
uniform float mesh_factor;
// The host's:
uniform float time_step;        // s
uniform vec3 box_min;           // around the shape (m)
uniform vec3 box_max;
uniform uint birth_first;       // slot of the step's first newborn
uniform uint birth_count;       // of this step
uniform uint birth_burst;       // the first so many of them are born at once,
uniform float birth_burst_rest; // so long before the end of the step (s)
uniform float birth_first_rest; // the next one so long before it,
uniform float birth_every;      // those after it later by so much each
#if MESH
uniform uint mesh_triangles;
uniform mat4 mesh_from; // mesh to world, at the begin of the step
uniform mat4 mesh_to;   // at its end
// Triangles and, for choosing one of them by its area with two random numbers, an alias table
// (Walker 1977; made as Vose 1991 does).
struct birth_triangle {
    vec4 corner; // w: probability of this one
    vec4 first;  // edge; w: the bits of the other one's index
    vec4 second; // edge
};
layout(std430) readonly buffer BirthTriangles { birth_triangle birth_triangles[]; };
#endif
#if AT
#include "lib/instance.glsl"
uniform uint birth_instances;
uniform mat4 birth_group; // their space to the world
layout(std430) readonly buffer Instances { instance_entry instances[]; };
layout(std430) readonly buffer BirthShares { float birth_sums[]; }; // of their shares, up to each
#endif
#if HAS_SHAPE
layout(r32ui) uniform uimage2D lost; // births that found no place
#endif
#define BIRTH_TRIES 256 // to find a place in the shape

// Seconds of the step that are left to it.
float birth_rest(uint index) {
    if (index < birth_burst) return birth_burst_rest;
    return clamp(birth_first_rest - float(index - birth_burst) * birth_every, 0.0, time_step);
}

vec3 birth_direction(float across, float around) { // evenly over the sphere
    float z = 1.0 - 2.0 * across, r = sqrt(max(1.0 - z * z, 0.0)), turn = 6.2831853 * around;
    return vec3(r * cos(turn), r * sin(turn), z);
}

// Turned by at most `spread`, evenly over the cap; `v` is not zero.
vec3 birth_spread(vec3 v, float a, float b) {
    float z = 1.0 - a * (1.0 - cos(radians(spread))), r = sqrt(max(1.0 - z * z, 0.0));
    vec3 n = normalize(v), side = normalize(abs(n.z) < 0.9 ? vec3(-n.y, n.x, 0.0) : vec3(0.0, -n.z, n.y));
    float turn = 6.2831853 * b;
    return length(v) * (z * n + r * (cos(turn) * side + sin(turn) * cross(n, side)));
}

#if MESH
uint birth_choose(uint id, uint what) {
    uint h = random_hash(id + random_hash(what + random_hash(particle_seed))), chosen, low;
    umulExtended(h, mesh_triangles, chosen, low);
    birth_triangle t = birth_triangles[chosen];
    return particle_random(id, what + 1u) < t.corner.w ? chosen : floatBitsToUint(t.first.w);
}
#endif

#if AT
// The first whose sum is above a random part of the whole.
uint birth_instance(uint id) {
    float wanted = particle_random(id, 4u) * birth_sums[birth_instances - 1u];
    uint low = 0u, high = birth_instances - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (birth_sums[middle] > wanted) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// From the instance's own space to the world.
void birth_place_at(instance_entry e, inout vec3 p, inout vec3 way, inout vec3 motion) {
    way = mat3(birth_group) * instance_vector(e, way);
    way /= max(length(way), 1e-20);
    motion = mat3(birth_group) * instance_vector(e, motion);
    p = (birth_group * vec4(instance_point(e, p), 1.0)).xyz;
}
#endif

// A place that may be one, the way out of there, and how the mesh moves there.
void birth_try(uint id, uint what, float share, out vec3 p, out vec3 way, out vec3 motion) {
    vec3 r = vec3(particle_random(id, what), particle_random(id, what + 1u), particle_random(id, what + 2u));
    motion = vec3(0.0);
#if MESH
    birth_triangle t = birth_triangles[birth_choose(id, what + 3u)];
    float s = sqrt(r.x); // Osada et al., "Shape distributions", 2002, section 4.2
    vec4 inside = vec4(t.corner.xyz + s * ((1.0 - r.y) * t.first.xyz + r.y * t.second.xyz), 1.0);
    vec3 from = (mesh_from * inside).xyz, to = (mesh_to * inside).xyz;
    p = mix(from, to, share);
    motion = (to - from) / time_step;
    way = normalize(mat3(mesh_to) * cross(t.first.xyz, t.second.xyz));
#elif HAS_SHAPE
    p = mix(box_min, box_max, r);
    way = p - 0.5 * (box_min + box_max);
    way /= max(length(way), 1e-20);
#else
    way = birth_direction(r.x, r.y);
    p = position + radius * pow(r.z, 1.0 / 3.0) * way;
#endif
}

bool birth_place(uint id, float share, out vec3 p, out vec3 way, out vec3 motion) {
#if HAS_SHAPE
    for (uint i = 0u; i < BIRTH_TRIES; i++) {
        birth_try(id, 128u + 8u * i, share, p, way, motion);
        if (field_shape(p) > threshold) return true;
    }
    imageAtomicAdd(lost, ivec2(0), 1u);
    return false;
#else
    birth_try(id, 128u, share, p, way, motion);
    return true;
#endif
}

vec3 birth_speed(uint id, vec3 p, vec3 way, vec3 motion) {
    vec3 v = field_speed(p) + outward * way;
    if (dot(v, v) > 0.0) v = birth_spread(v, particle_random(id, 1u), particle_random(id, 2u));
    v *= 1.0 - variation * particle_random(id, 3u);
    return v + mesh_factor * motion + (inherit != 0.0 ? inherit * field_velocity(p) : vec3(0.0));
}

// Its age is below 0 by what of the step is over when it is born. Without a place it is dead at once.
void main() {
    uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (index >= birth_count) return;
    uint slot = birth_first + index;
    slot -= slot < particle_count ? 0u : particle_count;
    uint id = particle_number(slot);
    float before = time_step - birth_rest(index);
    particle_said.random = particle_random(id, 64u);
    vec3 p, way, motion;
#if AT
    instance_entry e = instances[birth_instance(id)];
    instance_say(e);
    bool found = birth_place(id, before / time_step, p, way, motion);
    birth_place_at(e, p, way, motion);
#else
    bool found = birth_place(id, before / time_step, p, way, motion);
#endif
    vec4 moves = vec4(0.0);
    if (found) {
        moves.w = mix(lifetime_min, max(lifetime_min, lifetime_max), particle_random(id, 0u));
#if !CARRIED
        moves.xyz = birth_speed(id, p, way, motion);
#endif
    }
    particle_put(slot, vec4(p, found ? -before : 0.0), moves);
#if PARTICLE_QUANTITY
    particle_quantities[slot] = field_quantity(p);
#endif
}
