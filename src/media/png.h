// PNG pictures, 8 or 16 bits a channel.
#pragma once
#include "base/arena.h"
#include "media/limits.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct png_image {
    uint32_t width, height;
    int channels;       // 3 or 4
    int bits;           // 8 or 16 (16: native-endian uint16_t)
    const void *pixels; // rows from the top, tightly packed
} png_image;

typedef struct png_text {
    const char *key, *value;
} png_text; // tEXt / iTXt metadata

// Writes a file, atomically (base/file.h). `texts` may be NULL.
bool png_write(const char *path, const png_image *image, const png_text *texts, size_t text_count);
// Writes below `root` (base/file.h), for names that come from a file of a stranger.
bool png_write_inside(const char *root, const char *path, const png_image *image);
// Reads any PNG into `memory`, as RGBA of 8 bits (or 16 when the file has 16). The file may be a
// stranger's: the reader decodes it. `limits` NULL: picture_limits_default.
bool png_read(const char *path, const picture_limits *limits, arena *memory, png_image *out);
bool png_read_inside(const char *root, const char *path, const picture_limits *limits,
                     arena *memory, png_image *out);
// Reads the texts before the pixels into `memory`. Texts beyond PNG_MAX_TEXTS, or beyond 1 MiB in
// sum, are left out.
enum { PNG_MAX_TEXTS = 64 };
bool png_read_texts(const char *path, arena *memory, png_text out[PNG_MAX_TEXTS], size_t *count);

// Decode the bytes of a file in this process. `name` is for messages. `memory` NULL: reads only the
// size.
bool png_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                arena *memory, png_image *out);
bool png_decode_texts(const void *data, size_t size, const char *name, arena *memory,
                      png_text out[PNG_MAX_TEXTS], size_t *count);
bool png_work(const isolate_call *call); // this and the next two run in a worker
bool png_size_work(const isolate_call *call);
bool png_texts_work(const isolate_call *call);
