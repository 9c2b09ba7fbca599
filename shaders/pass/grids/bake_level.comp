// A mip level of a baked grid: means of two by two by two texels of the level before.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
uniform sampler3D finer;           //= input : the level before, of twice the size
writeonly uniform image3D values;  //= output rgba16f : the level

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    ivec3 size = imageSize(values);
    if (any(greaterThanEqual(voxel, size))) return;
    // Where eight texels meet, the linear filter gives their mean.
    vec3 corner = (vec3(voxel) + 0.5) / vec3(size);
    imageStore(values, voxel, textureLod(finer, corner, 0.0));
}
