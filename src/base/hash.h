// 128-bit content hashes (XXH3), for caches on disk. They are not cryptographic.
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct hash128 {
    uint64_t low, high;
} hash128;

hash128 hash_bytes(const void *data, size_t size);
hash128 hash_combine(hash128 a, hash128 b); // order matters
void hash_to_hex(hash128 h, char out[33]);
uint64_t hash64(const void *data, size_t size);
