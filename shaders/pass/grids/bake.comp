// Evaluates a field at every voxel centre of a box, into a grid.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
//@ option sampling = cubic {linear, quasi_cubic, cubic, nearest} : interpolation of the grids that the field samples
//@ field vec4 value : what is baked
#include "fields.glsl"
uniform vec3 box_min;
uniform vec3 box_max;
writeonly uniform image3D values; //= output rgba16f : the grid

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    ivec3 size = imageSize(values);
    if (any(greaterThanEqual(voxel, size))) return;
    vec3 p = mix(box_min, box_max, (vec3(voxel) + 0.5) / vec3(size));
    imageStore(values, voxel, field_value(p));
}
