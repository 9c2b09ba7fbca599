// Truevision, "TGA File Format Specification", version 2.0, 1991: image type 2.
#include "media/tga.h"
#include "base/file.h"
#include "base/memory.h"

enum { HEAD = 18, TRUE_COLOR = 2, FROM_THE_TOP = 0x20, ALPHA_BITS = 8 };

bool tga_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgba) {
    const size_t count = (size_t)width * height;
    uint8_t *bytes = mem_alloc(HEAD + 4 * count), *to = bytes + HEAD;
    bytes[2] = TRUE_COLOR;
    bytes[12] = (uint8_t)width;
    bytes[13] = (uint8_t)(width >> 8);
    bytes[14] = (uint8_t)height;
    bytes[15] = (uint8_t)(height >> 8);
    bytes[16] = 32;
    bytes[17] = FROM_THE_TOP | ALPHA_BITS;
    for (size_t i = 0; i < count; i++, to += 4, rgba += 4) {
        to[0] = rgba[2];
        to[1] = rgba[1];
        to[2] = rgba[0];
        to[3] = rgba[3];
    }
    bool done = file_write(path, bytes, HEAD + 4 * count);
    mem_free(bytes);
    return done;
}
