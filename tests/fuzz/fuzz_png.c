// PNG reader: any bytes give a picture or a message.
#include "base/error.h"
#include "media/png.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    arena memory = {0};
    png_image image;
    if (png_decode(data, size, "fuzz.png", &picture_limits_default, &memory, &image)) {
        if (image.width == 0 || image.height == 0 || !image.pixels) __builtin_trap();
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    arena_free(&memory);
    err_clear();
    return 0;
}
