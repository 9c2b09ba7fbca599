// Bytes of the same significance lie together before they are compressed: exponents of neighbouring
// numbers are alike, mantissas are not.
#include "media/pack.h"
#include <blosc.h>

// Measured on a plume of 64^3 cells (src/sim/README.md): zstd is a fifth smaller than lz4, and
// writing takes longer than either.
static const char codec[] = "zstd";
enum { LEVEL = 1 };

size_t pack_bytes(const void *data, size_t size, uint32_t width, void *out) {
    if (size == 0 || size > PACK_MOST) return 0;
    int length =
        blosc_compress_ctx(LEVEL, BLOSC_SHUFFLE, width, size, data, out, size, codec, 0, 1);
    return length > 0 && (size_t)length < size ? (size_t)length : 0;
}

bool pack_open(const void *packed, size_t length, void *out, size_t size) {
    size_t inside;
    return size > 0 && size <= PACK_MOST && blosc_cbuffer_validate(packed, length, &inside) == 0 &&
           inside == size && blosc_decompress_ctx(packed, out, size, 1) == (int)size;
}
