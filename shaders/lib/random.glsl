// Counter-based randomness: the same seed, frame and pixel give the same number.
#ifndef LIB_RANDOM_GLSL
#define LIB_RANDOM_GLSL

// PCG hash by Jarzynski and Olano (JCGT 9(3), 2020).
uint random_hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float random_pixel(uvec2 pixel, uint seed) {
    return float(random_hash(pixel.x + random_hash(pixel.y + random_hash(seed)))) * (1.0 / 4294967296.0);
}

// 64 x 64 texels, 32 frames, both without end: each frame is blue noise, and so is the sequence of
// each pixel (pass/generate/blue_noise.c). What is left of an error after a blur in space or a mean
// over frames is then far less than with white noise.
uniform sampler3D BlueNoise;

// Evenly spread over (0, 1).
float random_blue(uvec2 pixel, uint frame_number) {
    float texel = texelFetch(BlueNoise, ivec3(pixel & 63u, frame_number & 31u), 0).r;
    return (texel * 255.0 + 0.5) * (1.0 / 256.0);
}

// Two numbers that know nothing of each other: the second is read where the first step of the R2
// sequence leads (Roberts 2018), far from the first.
vec2 random_blue2(uvec2 pixel, uint frame_number) {
    return vec2(random_blue(pixel, frame_number), random_blue(pixel + uvec2(48, 36), frame_number));
}

#endif
