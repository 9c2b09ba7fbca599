// What eddies below the cells give back to those that cells can hold (Leith 1990; Schumann 1995): in each step
// the velocity is pushed at random, by as much as the gas is sheared there. The push is the curl of a vector
// potential, of which this finds component a on the edge along a at the lower end of each cell: so nothing is
// squeezed. Each component of the push is about h |S| sqrt(|S| dt) large, h being a cell and S the shear.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/velocity.glsl"
#include "lib/noise.glsl"

uniform float kick;  // of the push
uniform float reach; // cells in a step, by 1 m/s
uniform int turn;    // of the random numbers
layout(std430) writeonly buffer PyroPotential { PYRO_FOUR potential[]; }; // m/s, times a cell

vec3 at(ivec3 c) {
    return pyro_velocity_cell(pyro_near_of(pyro_into(c)));
}

// h |S|, m/s, without what gas expands, by velocities four cells apart; of the push as much as eddies that are
// as small have left room for: they are to have h^2 |S|^2 at most, so that pushes do not feed themselves.
float shear_at(ivec3 c, out float room) {
    vec3 x0 = at(c - ivec3(2, 0, 0)), y0 = at(c - ivec3(0, 2, 0)), z0 = at(c - ivec3(0, 0, 2));
    vec3 x1 = at(c + ivec3(2, 0, 0)), y1 = at(c + ivec3(0, 2, 0)), z1 = at(c + ivec3(0, 0, 2));
    vec3 x = 0.25 * (x1 - x0), y = 0.25 * (y1 - y0), z = 0.25 * (z1 - z0);
    vec3 along = vec3(x.x, y.y, z.z), across = vec3(y.z + z.y, z.x + x.z, x.y + y.x);
    along -= dot(along, vec3(1.0 / 3.0));
    float square = 2.0 * dot(along, along) + dot(across, across);
    vec3 small_ = at(c) - (x0 + x1 + y0 + y1 + z0 + z1) / 6.0;
    room = max(1.0 - dot(small_, small_) / max(square, 1e-12), 0.0);
    return sqrt(square);
}

// Evenly from -1 to 1.
vec3 random_of(ivec3 c) {
    uint seed = noise_hash(uint(turn));
    uint h = noise_hash(uint(c.x) + noise_hash(uint(c.y) + noise_hash(uint(c.z) + seed)));
    uvec3 all_ = uvec3(h, noise_hash(h), noise_hash(h + NOISE_NEXT_SEED));
    return vec3(all_ >> 8u) * (2.0 / 16777216.0) - 1.0;
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    float room, shear = shear_at(c, room);
    vec3 push = 0.5 * sqrt(3.0) * kick * shear * sqrt(min(reach * shear, 1.0) * room) * random_of(c); // a curl adds up four
    // Not beside faces, which nothing is to cross because of it.
    bvec3 beside = both(bvec3(lessThan(c, ivec3(2))), not(PYRO_AROUND));
    beside = bvec3(uvec3(beside) | uvec3(both(greaterThanEqual(c, PYRO_SIZE - 1), not(PYRO_AROUND))));
    if (any(beside)) push = vec3(0.0);
    potential[pyro_at(c)] = pyro_store(pyro_clean(vec4(push, 0.0)));
}
