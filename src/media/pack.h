// Numbers made smaller, and as they were: Blosc, which comes with OpenVDB.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PACK_MOST = 1 << 30 }; // bytes at once

// Packs `size` bytes, numbers of `width` bytes each, into at most as many at `out`. Returns how
// many it took; 0 when it does not get smaller. Any thread.
size_t pack_bytes(const void *data, size_t size, uint32_t width, void *out);
// The other way; false when `packed` was not made by it from so many bytes.
bool pack_open(const void *packed, size_t length, void *out, size_t size);
