// Measures of the difference of two pictures. Any thread.
#pragma once
#include <stdint.h>

// The two pictures of a comparison must have the same size, at least 1x1.
typedef struct compare_picture {
    uint32_t width, height;
    const float *rgb; // sRGB-encoded, 0 to 1, three numbers per pixel, rows from the top
} compare_picture;

// Peak signal-to-noise ratio over R, G and B in dB, with a peak of 1; INFINITY when equal.
double compare_psnr(const compare_picture *a, const compare_picture *b);

// Structural similarity, -1 to 1 (equal): Wang, Bovik, Sheikh and Simoncelli, "Image Quality
// Assessment: From Error Visibility to Structural Similarity" (2004), section III, with its
// Gaussian window of 11x11 pixels (sigma 1.5), K1 0.01 and K2 0.03. Returns the mean over the luma
// (Rec. 601) at all positions where the window lies inside of the picture. Along a side below 11
// pixels all positions count, and the border is repeated.
double compare_ssim(const compare_picture *a, const compare_picture *b);

// LDR-FLIP, 0 (equal) to 1: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom and Fairchild,
// "FLIP: A Difference Evaluator for Alternating Images" (2020), sections 4.1 (colour), 4.2
// (features) and 4.3 (both). Returns the mean over the picture; `map` receives width * height
// errors. `pixels_per_degree` is the observer's resolution: 67 for a 4K display, 0.7 m wide, seen
// from 0.7 m.
double compare_flip(const compare_picture *a, const compare_picture *b, double pixels_per_degree,
                    float *map);
