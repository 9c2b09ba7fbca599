// Lossless compression of arrays of numbers, by Blosc, which comes with OpenVDB. Any thread.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PACK_MOST = 1 << 30 }; // bytes at once

// Compresses `size` bytes, numbers of `width` bytes each, to `out`, which must hold as many.
// Returns the compressed size; 0 when it is not smaller.
size_t pack_bytes(const void *data, size_t size, uint32_t width, void *out);
// Decompresses to `size` bytes. False when `packed` does not hold so many.
bool pack_open(const void *packed, size_t length, void *out, size_t size);
