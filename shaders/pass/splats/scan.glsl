// One group: where the list of each tile begins, from how many entries it has.
#if defined(STAGE_SCAN)
const uint THREADS = 256u;
layout(local_size_x = THREADS) in;
shared uint before[THREADS];

void main() {
    uint thread = gl_LocalInvocationIndex, total = tiles_across * tiles_down;
    uint each = (total + THREADS - 1u) / THREADS, first = thread * each, end = min(first + each, total);
    uint sum = 0u;
    for (uint i = first; i < end; i++) sum += splat_tiles[i].y;
    before[thread] = sum;
    for (uint step = 1u; step < THREADS; step *= 2u) {
        barrier();
        uint other = thread >= step ? before[thread - step] : 0u;
        barrier();
        before[thread] += other;
    }
    uint at = before[thread] - sum;
    for (uint i = first; i < end; i++) {
        uint count = splat_tiles[i].y;
        splat_tiles[i] = uvec2(at); // its end goes on as `list` fills it
        at += count;
    }
}
#endif
