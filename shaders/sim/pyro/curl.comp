// Confinement (Fedkiw, Stam and Jensen 2001): in the middle of each cell the direction towards more
// vorticity, crossed with vorticity, times the side of a cell.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/trace.glsl"
#ifdef PYRO_CURL_LAST
layout(std430) readonly buffer PyroVorticity { PYRO_FOUR vorticity[]; };
layout(std430) writeonly buffer PyroCurl { PYRO_FOUR curl[]; };
#else
layout(std430) writeonly buffer PyroVorticity { PYRO_FOUR vorticity[]; };
#endif

vec3 around(ivec3 c, const int axis) { // difference of velocities two cells apart
    ivec3 low = c, high = c;
    low[axis] = pyro_into(axis, c[axis] - 1);
    high[axis] = pyro_into(axis, c[axis] + 1);
    return 0.5 * (pyro_velocity_cell(high) - pyro_velocity_cell(low));
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
#ifdef PYRO_CURL_LAST
    vec3 towards;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 low = c, high = c;
        low[axis] = pyro_into(axis, c[axis] - 1);
        high[axis] = pyro_into(axis, c[axis] + 1);
        towards[axis] = pyro_load(vorticity[pyro_at(high)], 3) - pyro_load(vorticity[pyro_at(low)], 3);
    }
    float length_ = length(towards);
    vec3 force = length_ > 1e-6 ? cross(towards / length_, pyro_load(vorticity[at]).xyz) : vec3(0.0);
    curl[at] = pyro_store(vec4(force, 0.0));
#else
    vec3 x = around(c, 0), y = around(c, 1), z = around(c, 2);
    vec3 w = vec3(y.z - z.y, z.x - x.z, x.y - y.x);
    vorticity[at] = pyro_store(vec4(w, length(w)));
#endif
}
