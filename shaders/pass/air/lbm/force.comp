// The acceleration of simulated air (pass/air/lbm.comp), as an image that its steps sample.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
#include "fields.glsl"
uniform vec3 box_min;
uniform vec3 box_max;
uniform writeonly image3D acceleration; //= output rgba16f : m/s^2

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    ivec3 size = imageSize(acceleration);
    if (any(greaterThanEqual(voxel, size))) return;
    vec3 p = mix(box_min, box_max, (vec3(voxel) + 0.5) / vec3(size));
    imageStore(acceleration, voxel, vec4(field_force(p), 0.0));
}
