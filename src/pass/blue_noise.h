// Blue noise in space and time, made while the program is built (generate/blue_noise.c).
#pragma once
#include "gpu/gpu.h"

enum { BLUE_NOISE_SIZE = 64, BLUE_NOISE_FRAMES = 32 };

// Slice by slice, row by row; value v stands for (v + 0.5) / 256.
extern const uint8_t blue_noise_texels[BLUE_NOISE_SIZE * BLUE_NOISE_SIZE * BLUE_NOISE_FRAMES];

gpu_image *blue_noise_create(gpu *device); // the texture "BlueNoise" of lib/random.glsl
