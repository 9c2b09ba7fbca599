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

// Atomic (base/file.h). `texts` may be NULL.
bool png_write(const char *path, const png_image *image, const png_text *texts, size_t text_count);
// Below `root` (base/file.h), where the name of the file follows from what strangers wrote.
bool png_write_inside(const char *root, const char *path, const png_image *image);
// Any PNG becomes RGBA at 8 bits (or 16 when the file has 16). It may be a stranger's: the reader
// decodes it. `limits` NULL: the usual ones.
bool png_read(const char *path, const picture_limits *limits, arena *memory, png_image *out);
bool png_read_inside(const char *root, const char *path, const picture_limits *limits,
                     arena *memory, png_image *out);
// Texts that stand before the pixels, into `memory`; those beyond PNG_MAX_TEXTS, or beyond 1 MiB
// together, are left out.
enum { PNG_MAX_TEXTS = 64 };
bool png_read_texts(const char *path, arena *memory, png_text out[PNG_MAX_TEXTS], size_t *count);

// Here and now, a file's bytes; `name` is for messages. Without `memory` its size alone.
bool png_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                arena *memory, png_image *out);
bool png_decode_texts(const void *data, size_t size, const char *name, arena *memory,
                      png_text out[PNG_MAX_TEXTS], size_t *count);
bool png_work(const isolate_call *call); // in a worker
bool png_size_work(const isolate_call *call);
bool png_texts_work(const isolate_call *call);
