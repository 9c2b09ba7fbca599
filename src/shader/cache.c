// Compiled SPIR-V on disk, one file for each key. The key is a hash of everything that the code
// depends on, so entries are never stale. A file whose header does not match its content is
// ignored. The cache only saves time: no failure here is an error.
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "shader/unit.h"
#include <stdio.h>
#include <string.h>

enum { CACHE_MAX_SIZE = 64 << 20 };

typedef struct cache_header {
    char magic[8];
    uint64_t size; // bytes of code after the header
    hash128 hash;  // of the code
    hash128 key;
} cache_header;

static const char magic[8] = "roilspv";

static bool path_of(const shader_library *library, hash128 key, char out[PATH_CAP]) {
    char hex[33], name[40];
    if (!library->cache_dir) return false;
    hash_to_hex(key, hex);
    snprintf(name, sizeof name, "%s.spv", hex);
    return path_join(out, library->cache_dir, name);
}

bool cache_load(const shader_library *library, hash128 key, spirv *out) {
    char path[PATH_CAP];
    void *data;
    size_t size;
    if (!path_of(library, key, path) || !file_exists(path) ||
        !file_read(path, CACHE_MAX_SIZE, &data, &size))
        return false;
    cache_header header;
    const char *code = (const char *)data + sizeof header;
    bool valid = size > sizeof header;
    if (valid) {
        memcpy(&header, data, sizeof header);
        valid = memcmp(header.magic, magic, sizeof magic) == 0 &&
                header.size == size - sizeof header && header.size % sizeof(uint32_t) == 0 &&
                hash_equal(header.key, key) &&
                hash_equal(header.hash, hash_bytes(code, header.size));
    }
    if (valid) {
        out->words = mem_copy(code, header.size);
        out->count = header.size / sizeof(uint32_t);
    } else {
        log_write(LOG_DEBUG, "%s: damaged, compiled again", path);
    }
    mem_free(data);
    return valid;
}

void cache_store(const shader_library *library, hash128 key, const spirv *code) {
    char path[PATH_CAP];
    if (!path_of(library, key, path)) return;
    size_t size = code->count * sizeof *code->words;
    cache_header header = {.size = size, .hash = hash_bytes(code->words, size), .key = key};
    memcpy(header.magic, magic, sizeof magic);
    strbuf file = {0};
    strbuf_append(&file, (const char *)&header, sizeof header);
    strbuf_append(&file, (const char *)code->words, size);
    if (!file_write(path, file.text, file.length))
        log_write(LOG_DEBUG, "shader not cached: %s", err_get());
    strbuf_free(&file);
}

bool shader_cache_holds_any(const char *cache_dir) {
    char pattern[PATH_CAP];
    file_list found;
    if (!path_join(pattern, cache_dir, "*.spv") || !file_glob(pattern, &found)) return false;
    bool any = found.count > 0;
    file_list_free(&found);
    return any;
}
