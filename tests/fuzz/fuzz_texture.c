// Textures, PNG and JPEG: any bytes give a picture or a message, here and, of the corpus and one
// input in sixteen, through the reader.
#include "base/error.h"
#include "media/texture.h"
#include "whole_way.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SEEDS = 32 }; // the first inputs, which are the corpus

static void read_whole_way(const uint8_t *data, size_t size) {
    arena memory = {0};
    mesh_texture texture;
    if (!texture_read_memory(data, size, "fuzz", &memory, &texture)) fuzz_expect_message();
    arena_free(&memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (fuzz_has_word_of_crash(data, size)) return 0;
    static unsigned count;
    static const picture_limits limits = {2048, 2048, 8 << 20};
    arena memory = {0};
    mesh_texture texture;
    if (texture_decode(data, size, "fuzz", &limits, &memory, &texture)) {
        if (texture.width == 0 || texture.height == 0 || !texture.pixels) __builtin_trap();
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    arena_free(&memory);
    err_clear();
    if (count++ % 16 == 0 || count < SEEDS) read_whole_way(data, size);
    err_clear();
    return 0;
}
