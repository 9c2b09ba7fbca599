// A wall across the view at one depth, for tests of the march against a scene.
uniform float distance_to;         //= 5 [0, 1000] m : depth of the wall
writeonly uniform image2D depth;   //= output r32f : depth (m)
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth)))) return;
    imageStore(depth, pixel, vec4(distance_to));
}
