// EXR as `compare` and panoramas read it, in this process: a crash is a crash. Any bytes give
// channels of the size that the header says, or a message.
#include "base/error.h"
#include "media/exr.h"
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const letters[] = {"RGB", "RGBY", NULL};
    for (size_t i = 0; i < 3; i++) {
        const exr_wish wish = {letters[i],
                               {16384, 16384, 16 << 20}}; // mutated headers ask for more
        arena memory = {0};
        exr_image image;
        float sum = 0;
        if (exr_decode(data, size, "fuzz.exr", &wish, NULL, &image) &&
            (!image.width || !image.height))
            __builtin_trap(); // the size alone
        if (exr_decode(data, size, "fuzz.exr", &wish, &memory, &image)) {
            size_t count = (size_t)image.width * image.height;
            if (count == 0) __builtin_trap();
            for (size_t c = 0; c < image.channel_count; c++) {
                const char *channel = image.channels[c].name;
                if (letters[i] && !strchr(letters[i], channel[0])) __builtin_trap();
                if (!exr_find(&image, channel)) __builtin_trap();
                for (size_t p = 0; p < count; p++) sum += image.channels[c].values[p];
            }
        } else if (!err_get()[0]) {
            __builtin_trap();
        }
        volatile float kept = sum; // all of it was read
        (void)kept;
        arena_free(&memory);
        err_clear();
    }
    return 0;
}
