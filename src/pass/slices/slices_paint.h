// Painted obstacles: a picture as a texture that is not much finer than the cells which sample it.
#pragma once
#include "gpu/gpu.h"

struct picture;

// Between frames; NULL with a message.
gpu_image *slices_paint(gpu *g, const struct picture *painted, const uint32_t cells[2]);
