// Textures, PNG and JPEG: any bytes give a picture or a message.
#include "base/error.h"
#include "media/texture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
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
    return 0;
}
