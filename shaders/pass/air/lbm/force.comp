// The acceleration of simulated air (pass/air/lbm.comp), or, with GUIDE, its guide (pass/air/pyro.comp), as an
// image that its steps sample.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
#include "fields.glsl"
uniform vec3 box_min;
uniform vec3 box_max;
uniform vec3 count; // of texels that are wanted
uniform writeonly image3D acceleration; //= output rgba16f : m/s^2; m/s of a guide

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(vec3(voxel), count))) return;
    vec3 p = mix(box_min, box_max, (vec3(voxel) + 0.5) / count);
#ifdef GUIDE
    imageStore(acceleration, voxel, vec4(field_guide(p), 0.0));
#else
    imageStore(acceleration, voxel, vec4(field_force(p), 0.0));
#endif
}
