// A flipbook of two by two images: red, green, blue, and one that is clear.
writeonly uniform image2D color; //= output rgba16f : the images
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    ivec2 cell = 2 * pixel / size;
    vec3 own = vec3(cell.x == 0 && cell.y == 0, cell.x == 1 && cell.y == 0, cell.x == 0 && cell.y == 1);
    imageStore(color, pixel, vec4(own, max(own.r, max(own.g, own.b))));
}
