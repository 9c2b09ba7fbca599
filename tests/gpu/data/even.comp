// One colour everywhere.
uniform vec3 tint;                 //= {1, 1, 1} [0, 60000] : the colour
writeonly uniform image2D color;   //= output rgba16f : the picture
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color)))) return;
    imageStore(color, pixel, vec4(tint, 1.0));
}
