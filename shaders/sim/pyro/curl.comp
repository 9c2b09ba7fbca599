// Confinement (Fedkiw, Stam and Jensen 2001): in the middle of each cell the direction towards more
// vorticity, crossed with vorticity, times the side of a cell.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/velocity.glsl"
#ifdef PYRO_CURL_LAST
layout(std430) readonly buffer PyroVorticity { PYRO_FOUR vorticity[]; };
layout(std430) writeonly buffer PyroCurl { PYRO_FOUR curl[]; };
#else
layout(std430) writeonly buffer PyroVorticity { PYRO_FOUR vorticity[]; };
#endif

vec3 at(ivec3 c) {
    return pyro_velocity_cell(pyro_near_of(pyro_into(c)));
}

vec3 around(ivec3 c, ivec3 way) { // difference of velocities two cells apart
    return 0.5 * (at(c + way) - at(c - way));
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int here = pyro_at(c);
#ifdef PYRO_CURL_LAST
    ivec3 p = pyro_places(c), low = pyro_places(pyro_into(c - 1)), high = pyro_places(pyro_into(c + 1));
    vec3 towards = vec3(PYRO_W(vorticity[high.x + p.y + p.z]) - PYRO_W(vorticity[low.x + p.y + p.z]),
                        PYRO_W(vorticity[p.x + high.y + p.z]) - PYRO_W(vorticity[p.x + low.y + p.z]),
                        PYRO_W(vorticity[p.x + p.y + high.z]) - PYRO_W(vorticity[p.x + p.y + low.z]));
    float length_ = length(towards);
    vec3 force = length_ > 1e-6 ? cross(towards / length_, pyro_load(vorticity[here]).xyz) : vec3(0.0);
    // Not beside faces, through which eddies shall leave.
    if (any(lessThan(c, ivec3(2))) || any(greaterThanEqual(c, PYRO_SIZE - 2))) force = vec3(0.0);
    curl[here] = pyro_store(vec4(force, 0.0));
#else
    vec3 x = around(c, ivec3(1, 0, 0)), y = around(c, ivec3(0, 1, 0)), z = around(c, ivec3(0, 0, 1));
    vec3 w = vec3(y.z - z.y, z.x - x.z, x.y - y.x);
    vorticity[here] = pyro_store(vec4(w, length(w)));
#endif
}
