// Pictures that effects are made from, by what the reader runs, and then the whole way: any bytes,
// as the kind of file that their beginning suggests, give finite numbers or a message. What the
// reader runs is called here, so that its crash is seen, and then through the reader, the corpus
// and one input in sixteen, as that takes a process each.
#include "base/error.h"
#include "base/file.h"
#include "media/exr.h"
#include "media/picture.h"
#include "media/png.h"
#include "whole_way.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SEEDS = 32 }; // the first inputs, which are the corpus

enum { SIDE_MAX = 512 };
static char folder[PATH_CAP], files[2][PATH_CAP];

static void clean(void) {
    for (int i = 0; i < 2; i++) unlink(files[i]);
    rmdir(folder);
}

static void prepare(void) {
    static const char *const NAMES[2] = {"a.exr", "a.png"};
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/roil-fuzz-XXXXXX", base ? base : P_tmpdir);
    if (!mkdtemp(folder)) __builtin_trap();
    for (int i = 0; i < 2; i++)
        if (!path_join(files[i], folder, NAMES[i])) __builtin_trap();
    atexit(clean);
}

static bool decode(bool png, const uint8_t *data, size_t size, arena *memory) {
    const exr_wish wish = {"RGBAY", {SIDE_MAX, SIDE_MAX, 16 << 20}};
    exr_image exr;
    png_image image;
    return png ? png_decode(data, size, "a.png", &wish.limits, memory, &image)
               : exr_decode(data, size, "a.exr", &wish, memory, &exr);
}

static void read_whole_way(bool png, const uint8_t *data, size_t size) {
    arena memory = {0};
    picture p;
    fuzz_write(files[png], data, size);
    if (picture_read(files[png], folder, SIDE_MAX, &memory, &p)) {
        for (size_t i = 0; i < 4 * (size_t)p.width * p.height; i++)
            if (!isfinite(p.rgba[i])) __builtin_trap();
    } else {
        fuzz_expect_message();
    }
    arena_free(&memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (fuzz_has_word_of_crash(data, size)) return 0;
    static unsigned count;
    if (!folder[0]) prepare();
    bool png = size > 0 && data[0] == 0x89;
    arena memory = {0};
    if (!decode(png, data, size, &memory) && !err_get()[0]) __builtin_trap();
    arena_free(&memory);
    if (count++ % 16 == 0 || count < SEEDS) read_whole_way(png, data, size);
    err_clear();
    return 0;
}
