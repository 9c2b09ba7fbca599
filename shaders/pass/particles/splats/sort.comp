// Sorts pairs of a key and a number by four bits of the key at a time, in three stages, whose places
// are known before anything moves: equal keys stay in order (Satish, Harris and Garland, "Designing
// efficient sorting algorithms for manycore GPUs", 2009). SORT_THREADS is a group's.
const uint DIGITS = 16u, ITEMS = 16u, BLOCK = SORT_THREADS * ITEMS; // of a thread, of a group
layout(local_size_x = SORT_THREADS) in;

layout(std430) readonly buffer SortFrom { uvec2 sort_from[]; };
layout(std430) writeonly buffer SortTo { uvec2 sort_to[]; };
layout(std430) buffer SortCounts { uint sort_counts[]; }; // of each digit, all groups one by one
layout(std430) readonly buffer SplatHead { uint splat_found; uint splat_listed; };
uniform uint entries_most;
uniform uint shift; // of the digit in the key

uint pair_count() { return min(splat_listed, entries_most); }
uint block_count() { return (pair_count() + BLOCK - 1u) / BLOCK; }
uint digit_of(uvec2 pair) { return (pair.x >> shift) & (DIGITS - 1u); }

#if defined(STAGE_SORT_COUNT)
shared uint found[DIGITS];

void main() {
    uint thread = gl_LocalInvocationIndex, block = gl_WorkGroupID.x, count = pair_count();
    if (block >= block_count()) return; // the whole group
    for (uint i = thread; i < DIGITS; i += SORT_THREADS) found[i] = 0u;
    barrier();
    for (uint i = 0u; i < ITEMS; i++) {
        uint at = block * BLOCK + i * SORT_THREADS + thread;
        if (at < count) atomicAdd(found[digit_of(sort_from[at])], 1u);
    }
    barrier();
    for (uint i = thread; i < DIGITS; i += SORT_THREADS) sort_counts[i * block_count() + block] = found[i];
}
#endif

#if defined(STAGE_SORT_SCAN) || defined(STAGE_SORT_MOVE)
shared uint before[SORT_THREADS];

// Sum of what the threads before have.
uint sum_before(uint own) {
    uint thread = gl_LocalInvocationIndex;
    before[thread] = own;
    for (uint step = 1u; step < SORT_THREADS; step *= 2u) {
        barrier();
        uint other = thread >= step ? before[thread - step] : 0u;
        barrier();
        before[thread] += other;
    }
    return before[thread] - own;
}
#endif

#if defined(STAGE_SORT_SCAN)
void main() { // one group
    uint total = DIGITS * block_count(), each = (total + SORT_THREADS - 1u) / SORT_THREADS;
    uint first = gl_LocalInvocationIndex * each, end = min(first + each, total), sum = 0u;
    for (uint i = first; i < end; i++) sum += sort_counts[i];
    uint at = sum_before(sum);
    for (uint i = first; i < end; i++) {
        uint count = sort_counts[i];
        sort_counts[i] = at;
        at += count;
    }
}
#endif

#if defined(STAGE_SORT_MOVE)
shared uint place[DIGITS * SORT_THREADS]; // of a thread's next pair of each digit, in the sorted block
shared uint starts[DIGITS];                 // from there to its place among all

void main() {
    uint thread = gl_LocalInvocationIndex, block = gl_WorkGroupID.x, count = pair_count();
    if (block >= block_count()) return; // the whole group
    uint first = block * BLOCK + thread * ITEMS, end = min(first + ITEMS, count);
    for (uint i = 0u; i < DIGITS; i++) place[i * SORT_THREADS + thread] = 0u;
    for (uint i = first; i < end; i++) place[digit_of(sort_from[i]) * SORT_THREADS + thread]++;
    barrier();
    uint sum = 0u;
    for (uint i = 0u; i < DIGITS; i++) sum += place[thread * DIGITS + i];
    uint at = sum_before(sum);
    for (uint i = 0u; i < DIGITS; i++) {
        uint own = place[thread * DIGITS + i];
        place[thread * DIGITS + i] = at;
        at += own;
    }
    barrier();
    for (uint i = thread; i < DIGITS; i += SORT_THREADS)
        starts[i] = sort_counts[i * block_count() + block] - place[i * SORT_THREADS];
    barrier();
    for (uint i = first; i < end; i++) {
        uvec2 pair = sort_from[i];
        uint digit = digit_of(pair);
        sort_to[starts[digit] + place[digit * SORT_THREADS + thread]++] = pair;
    }
}
#endif
