// Adds one to what it made a frame ago.
uniform sampler2D before;          //= input history count : last frame's count
writeonly uniform image2D count;   //= output rgba16f : frames so far
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(count)))) return;
    imageStore(count, pixel, texelFetch(before, pixel, 0) + 1.0);
}
