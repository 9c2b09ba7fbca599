// Sweeps of strangers: any file gives rows that are complete and of one line, or a message.
#include "base/log.h"
#include "script/sweep.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char folder[] = "/tmp/roil-fuzz-sweep-XXXXXX", file[64], effect[64];

static void remove_files(void) {
    unlink(file);
    unlink(effect);
    rmdir(folder);
}

static void write_file(const char *path, const void *data, size_t size) {
    FILE *out = fopen(path, "wb");
    if (!out || (size && fwrite(data, 1, size, out) != size) || fclose(out)) abort();
}

static void put(const uint8_t *data, size_t size) {
    if (!file[0]) {
        if (!mkdtemp(folder)) abort();
        snprintf(file, sizeof file, "%s/s.lua", folder);
        snprintf(effect, sizeof effect, "%s/puff.lua", folder);
        write_file(effect, "", 0);
        log_set_level(LOG_ERROR);
        atexit(remove_files);
    }
    write_file(file, data, size);
}

static void require_one_line(const char *text) {
    for (; *text; text++)
        if (iscntrl((unsigned char)*text)) abort();
}

static void require_row(const sweep *s, const sweep_row *row) {
    require_one_line(row->label);
    require_one_line(row->effect);
    if (row->width < 1 || row->height < 1 || row->width > 16384 || row->height > 16384) abort();
    if (row->repeats < 1 || row->axis_count != (row->axes ? s->axis_count : 0)) abort();
    if (s->measure == SWEEP_FRAMES && !row->frame_count && !(row->last > row->first)) abort();
    if (row->reference != SWEEP_NO_REFERENCE && row->reference >= s->reference_count) abort();
    for (size_t i = 0; i < row->setting_count; i++) {
        require_one_line(row->settings[i].name);
        require_one_line(row->settings[i].text);
        if (i && strcmp(row->settings[i - 1].name, row->settings[i].name) >= 0) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    arena memory = {0};
    sweep s;
    sweep_options options = {.warmup = -1, .repeats = -1, .limit = -1, .settle = -1};
    if (size % 2) {
        options.width = 64;
        options.height = 36;
    }
    put(data, size);
    err_clear();
    if (sweep_read(file, &options, &memory, &s)) {
        if (s.row_count < 1 || s.row_count > SWEEP_MAX_ROWS) abort();
        for (size_t i = 0; i < s.row_count; i++) require_row(&s, &s.rows[i]);
    } else if (!err_get()[0]) {
        abort();
    }
    arena_free(&memory);
    return 0;
}
