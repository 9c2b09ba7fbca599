// One direction of the blur of bloom.comp's mode gaussian: nine taps, weighted as published. STAGE_BLUR_FIRST
// reads the picture, STAGE_BLUR what was blurred before.
uniform int down;   // 1: the taps lie below each other, 0: side by side

const float WEIGHTS[5] = float[](0.227027, 0.1945946, 0.1216216, 0.054054, 0.016216);

vec3 tap(ivec2 texel, ivec2 size) {
    texel = clamp(texel, ivec2(0), size - 1);
#if STAGE_BLUR_FIRST && !SAME_SIZE // all of a picture that is up to four times as large
    vec2 uv = (vec2(texel) + 0.5) / vec2(size), away = 0.25 / vec2(size);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; i++) sum += picture_look(uv + away * (2.0 * vec2(i & 1, i >> 1) - 1.0));
    return 0.25 * sum;
#elif STAGE_BLUR_FIRST
    return picture_at(texel, size);
#else
    return texelFetch(source, texel, 0).rgb;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    ivec2 way = down == 1 ? ivec2(0, spread) : ivec2(spread, 0);
    vec3 sum = WEIGHTS[0] * tap(pixel, size);
    for (int i = 1; i < 5; i++) sum += WEIGHTS[i] * (tap(pixel + i * way, size) + tap(pixel - i * way, size));
    imageStore(color, pixel, vec4(sum, 1.0));
}
