// A bright square on black, for tests of the bloom.
writeonly uniform image2D color;   //= output rgba16f : the picture
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    bool lit = all(lessThan(abs(pixel - size / 2), ivec2(4)));
    imageStore(color, pixel, lit ? vec4(8.0, 4.0, 2.0, 1.0) : vec4(0.25, 0.25, 0.25, 1.0));
}
