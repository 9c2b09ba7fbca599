#include "base/hash.h"
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

hash128 hash_bytes(const void *data, size_t size) {
    XXH128_hash_t h = XXH3_128bits(data, size);
    return (hash128){h.low64, h.high64};
}

hash128 hash_combine(hash128 a, hash128 b) {
    hash128 pair[2] = {a, b};
    return hash_bytes(pair, sizeof pair);
}

hash128 hash_add_text(hash128 h, const char *text) {
    return hash_combine(h, hash_bytes(text ? text : "", text ? strlen(text) : 0));
}

bool hash_equal(hash128 a, hash128 b) {
    return a.low == b.low && a.high == b.high;
}

void hash_to_hex(hash128 h, char out[33]) {
    snprintf(out, 33, "%016llx%016llx", (unsigned long long)h.high, (unsigned long long)h.low);
}

uint64_t hash64(const void *data, size_t size) {
    return XXH3_64bits(data, size);
}
