// Targa pictures, which engines and old tools read.
#pragma once
#include <stdbool.h>
#include <stdint.h>

// Writes a file atomically (base/file.h): uncompressed, 32 bits a pixel, rows from the top. `rgba`
// has width * height * 4 bytes; sides are at most 65535.
bool tga_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgba);
