// Black in the first column, then 15 stops of light, dark to bright; alpha grows from row to row.
uniform vec3 tint;                 //= {1, 1, 1} [0, 100] : factor by channel
writeonly uniform image2D color;   //= output rgba16f : the ramp
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    float stops = mix(-10.0, 5.0, float(pixel.x - 1) / float(size.x - 2));
    float light = pixel.x == 0 ? 0.0 : exp2(stops);
    imageStore(color, pixel, vec4(light * tint, (float(pixel.y) + 0.5) / float(size.y)));
}
