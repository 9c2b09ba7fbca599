// Presets of strangers: any file gives settings whose names and texts stand on one line, or a
// message.
#include "base/log.h"
#include "script/preset.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char file[] = "/tmp/roil-fuzz-preset-XXXXXX";

static void remove_file(void) {
    unlink(file);
}

static void put(const uint8_t *data, size_t size) {
    static int made = -1;
    if (made < 0) {
        made = mkstemp(file);
        if (made < 0) abort();
        close(made);
        log_set_level(LOG_ERROR);
        atexit(remove_file);
    }
    FILE *out = fopen(file, "wb");
    if (!out || (size && fwrite(data, 1, size, out) != size) || fclose(out)) abort();
}

static void require_one_line(const char *text) {
    for (; *text; text++)
        if (iscntrl((unsigned char)*text)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    arena memory = {0};
    effect_setting *settings;
    size_t count;
    put(data, size);
    err_clear();
    if (!preset_read(NULL, file, &memory, &settings, &count) && !err_get()[0]) abort();
    for (size_t i = 0; i < count; i++) {
        require_one_line(settings[i].name);
        require_one_line(settings[i].text);
    }
    arena_free(&memory);
    return 0;
}
