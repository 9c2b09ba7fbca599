// Checkpoints: any file gives parts of the sizes that it names, or a message. Hashes are made right
// first, as a stranger would, so that what lies behind them is reached.
#include "base/error.h"
#include "base/hash.h"
#include "sim/checkpoint.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// The layout of the file (sim/checkpoint.c).
enum {
    HEAD = 24,
    COUNT = 12,
    HASH = 16,
    ENTRY = 88,
    SIZE = 64,
    OFFSET = 72,
    CHUNK = 16,
    MOST = 1 << 20
};

static uint64_t get(const uint8_t *at, size_t bytes) {
    uint64_t value = 0;
    memcpy(&value, at, bytes);
    return value;
}

static void put_hash(uint8_t *at, const uint8_t *data, size_t size) {
    uint64_t hash = hash64(data, size);
    memcpy(at, &hash, sizeof hash);
}

static void seal(uint8_t *data, size_t size) {
    if (size < HEAD) return;
    size_t count = get(data + COUNT, 4), at = HEAD + count * ENTRY;
    if (count > CHECKPOINT_PARTS || at > size) return;
    put_hash(data + HASH, data + HEAD, count * ENTRY);
    while (size - at > CHUNK) {
        size_t stored = get(data + at + 4, 4);
        if (stored > size - at - CHUNK) return;
        put_hash(data + at + 8, data + at + CHUNK, stored);
        at += CHUNK + stored;
    }
}

static void load(checkpoint *c, const char *name) {
    uint64_t size;
    err_clear();
    if (!checkpoint_require(c, name, "lattice 64 64 64\nstep 0.01\n") && !err_get()[0]) abort();
    if (!checkpoint_has(c, name, &size) || size > MOST) return;
    uint8_t *bytes = malloc(size ? size : 1); // of the exact size: an overrun is caught
    if (!bytes) abort();
    checkpoint_part part = {.name = name, .size = size, .bytes = bytes};
    if (!checkpoint_load(c, NULL, &part) && !err_get()[0]) abort();
    free(bytes);
}

static void try(const uint8_t *data, size_t size) {
    int fd = memfd_create("fuzz.state", 0);
    char path[64], name[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    if (fd < 0 || write(fd, data, size) != (ssize_t)size) abort();
    err_clear();
    checkpoint *c = checkpoint_open(path);
    if (!c && !err_get()[0]) abort();
    for (size_t i = 0; c && i < get(data + COUNT, 4); i++) {
        memcpy(name, data + HEAD + i * ENTRY, sizeof name);
        load(c, name); // it was opened: the name ends
    }
    checkpoint_close(c);
    close(fd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t *copy = malloc(size ? size : 1);
    if (!copy) abort();
    memcpy(copy, data, size);
    try(copy, size);
    seal(copy, size);
    try(copy, size);
    free(copy);
    return 0;
}
