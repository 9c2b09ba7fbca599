// The transfer function of sRGB (IEC 61966-2-1): between light and what files and displays have.
#pragma once
#include <math.h>

static inline float srgb_from_linear(float v) {
    return v <= 0.0031308f ? v * 12.92f : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
}

static inline float linear_from_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}
