// Bundles of strangers: whatever is listed lies in the file, has a name that stays in its folder,
// and is there once; a refusal says why.
#include "base/error.h"
#include "base/memory.h"
#include "media/bundle.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_name(const char *name) {
    if (!name[0] || name[0] == '/' || !bundle_is_name(name)) abort();
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        size_t length = strcspn(part, "/");
        if (!length || (length == 1 && part[0] == '.') || strncmp(part, "../", 3) == 0 ||
            strcmp(part, "..") == 0)
            abort();
    }
}

static void check(const bundle *b, size_t size) {
    if (!b->count || b->count > BUNDLE_MAX_FILES || !b->name || strchr(b->name, '/')) abort();
    check_name(b->name);
    for (size_t i = 0; i < b->count; i++) {
        const bundle_file *f = &b->files[i];
        check_name(f->name);
        if (f->at > size || f->size > size - f->at) abort();
        if (i && strcmp(f[-1].name, f->name) >= 0) abort();
    }
}

// Makes the sum of every header right, without which nothing else of it would be looked at.
static void mend_sums(uint8_t *data, size_t size) {
    for (uint8_t *h = data; h + 512 <= data + size; h += 512) {
        unsigned sum = 0;
        if (memcmp(h + 257, "ustar", 5) != 0) continue;
        memset(h + 148, ' ', 8);
        for (int i = 0; i < 512; i++) sum += h[i];
        snprintf((char *)h + 148, 7, "%06o", sum);
    }
}

static void read_all(const uint8_t *data, size_t size) {
    int file = memfd_create("bundle", MFD_CLOEXEC);
    if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
    bundle b;
    err_clear();
    if (bundle_read(file, size, &b))
        check(&b, size);
    else if (!err_get()[0])
        abort();
    arena_free(&b.memory);
    close(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t *mended = mem_copy(data, size);
    mend_sums(mended, size);
    read_all(data, size);
    read_all(mended, size);
    mem_free(mended);
    return 0;
}
