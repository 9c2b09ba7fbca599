// What a guide adds to the velocity in a step: in each of its cells the difference between it and the mean
// velocity there, at the rate at which that is taken back. Eddies that are smaller than these cells have no
// mean, and stay free (Thuerey et al. 2006).
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/velocity.glsl"

uniform vec3 guide_cells;  // in the box along each axis
uniform float guide_share; // of the difference
uniform sampler3D guide;   // m/s, in its first texels
layout(rgba16f) writeonly uniform image3D pull; // m/s, the same

void main() {
    ivec3 to = ivec3(gl_GlobalInvocationID), size = ivec3(guide_cells), n = PYRO_SIZE / size;
    if (any(greaterThanEqual(to, size))) return;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < n.x * n.y * n.z; i++)
        sum += pyro_velocity_cell(pyro_near_of(to * n + ivec3(i % n.x, i / n.x % n.y, i / (n.x * n.y))));
    vec3 mean = sum / float(n.x * n.y * n.z);
    imageStore(pull, to, vec4(guide_share * (texelFetch(guide, to, 0).xyz - mean), 0.0));
}
