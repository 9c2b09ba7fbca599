// What the meshes left of the depth, before or behind that of the scene.
layout(local_size_x = 16, local_size_y = 16) in;
uniform sampler2D drawn_front;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(front);
    if (any(greaterThanEqual(pixel, size))) return;
    float stop = shell_stop((vec2(pixel) + 0.5) / vec2(size));
    imageStore(front, pixel, vec4(min(texelFetch(drawn_front, pixel, 0).r, stop)));
}
