// 128-bit content hashes (XXH3), for caches on disk. They are not cryptographic.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct hash128 {
    uint64_t low, high;
} hash128;

hash128 hash_bytes(const void *data, size_t size);
hash128 hash_combine(hash128 a, hash128 b);         // order matters
hash128 hash_add_text(hash128 h, const char *text); // combines it with a text; NULL is as ""
bool hash_equal(hash128 a, hash128 b);
void hash_to_hex(hash128 h, char out[33]);
uint64_t hash64(const void *data, size_t size);
