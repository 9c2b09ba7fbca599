// Half of grey, which ends far behind what is seen in the middle four texels, and not at it elsewhere.
writeonly uniform image2D color;   //= output rgba16f : the volume
writeonly uniform image2D edge;    //= output r32f : where it ends (m)
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    bvec2 middle = lessThan(abs(2 * pixel + 1 - size), ivec2(2));
    imageStore(color, pixel, vec4(0.25, 0.25, 0.25, 0.5));
    imageStore(edge, pixel, vec4(all(middle) ? 1000.0 : 11.0));
}
