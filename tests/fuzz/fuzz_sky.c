// Panoramas: any bytes give a sky or a message, and none crashes the reader (fuzz_exr.c runs what
// it runs in process).
#include "base/error.h"
#include "base/file.h"
#include "scene/sky_image.h"
#include "whole_way.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char folder[PATH_CAP], file[PATH_CAP];

static void clean(void) {
    unlink(file);
    rmdir(folder);
}

static void prepare(void) {
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/roil-fuzz-XXXXXX", base ? base : P_tmpdir);
    if (!mkdtemp(folder) || !path_join(file, folder, "sky.exr")) __builtin_trap();
    atexit(clean);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (fuzz_has_word_of_crash(data, size)) return 0;
    if (!folder[0]) prepare();
    fuzz_write(file, data, size);
    arena memory = {0};
    float zenith[3], horizon[3];
    const sky_image *s = sky_image_load(file, folder, &memory);
    if (s) {
        sky_image_means(s, zenith, horizon);
        for (int i = 0; i < 3; i++)
            if (!isfinite(zenith[i]) || zenith[i] < 0 || !isfinite(horizon[i])) __builtin_trap();
    } else {
        fuzz_expect_message();
    }
    arena_free(&memory);
    err_clear();
    return 0;
}
