// Optical flow: how one picture has become the next, estimated from the pictures alone. It is
// OpenCV's, in a library that is loaded when it is asked for (media/optical/optical_flow.cpp).
#pragma once
#include <stdbool.h>
#include <stdint.h>

// Loads the library beside the program. False with a message where it is not, or lacks OpenCV. Any
// thread.
bool optical_flow_load(void);
// Of each pixel of `from`: where it is in `to`, in pixels to the right and down from its place.
// Pictures are of 8 bits and at least 12 x 12; `out` has room for 2 * width * height. Call
// optical_flow_load before.
bool optical_flow_find(const uint8_t *from, const uint8_t *to, uint32_t width, uint32_t height,
                       float *out);

// What the library has, by this name.
typedef bool optical_flow_function(const uint8_t *from, const uint8_t *to, int width, int height,
                                   float *out);
#define OPTICAL_FLOW_FUNCTION "roil_optical_flow"
