// Writes the texture "BlueNoise" as C text: run while the program is built.
//
// Void and cluster (Ulichney 1993) in space and time at once (Wolfe, Morrical, Akenine-Moller and
// Ramamoorthi 2022, "Spatiotemporal blue noise masks", section 4): texels repel each other within
// their slice, and each texel repels itself in the slices before and after, all around the edges.
// Every slice is then blue noise, and so is the sequence of every texel. Whole numbers throughout,
// so that all machines make the same.
#include "pass/blue_noise.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    SIZE = BLUE_NOISE_SIZE,
    FRAMES = BLUE_NOISE_FRAMES,
    SLICE = SIZE * SIZE,
    COUNT = SLICE * FRAMES,
    ROWS = SIZE * FRAMES,
    REACH = 10, // texels; beyond it a texel's energy is below a thousandth of a thousandth
    FIRST = COUNT / 10,
};

static const uint32_t FULL = 0xffffffff; // energy of a texel that must not be found

static uint32_t kernel[2 * REACH + 1]; // by distance along an axis, from -REACH, times 4096
static uint32_t energy[COUNT];         // of what is set
static bool set[COUNT];
static uint32_t rank[COUNT];
static uint32_t emptiest[ROWS], fullest[ROWS]; // energies: the voids and clusters of each row

// exp(-d^2 / (2 s^2)) with s = 1.9: multiplied up, as libraries of mathematics differ in last
// digits.
static void make_kernel(void) {
    const double step = 0.870662870587; // exp(-1 / (2 * 1.9 * 1.9))
    for (int d = 0; d <= REACH; d++) {
        double value = 4096;
        for (int i = 0; i < d * d; i++) value *= step;
        kernel[REACH + d] = kernel[REACH - d] = (uint32_t)(value + 0.5);
    }
}

static void search_row(int row) {
    uint32_t least = FULL, most = 0;
    for (int i = row * SIZE; i < (row + 1) * SIZE; i++) {
        uint32_t hole = set[i] ? FULL : energy[i], dot = set[i] ? energy[i] : 0;
        least = hole < least ? hole : least;
        most = dot > most ? dot : most;
    }
    emptiest[row] = least;
    fullest[row] = most;
}

static void change(int texel, bool on) {
    int frame = texel / SLICE, y = texel % SLICE / SIZE, x = texel % SIZE;
    uint32_t sign = on ? 1 : (uint32_t)-1; // unsigned: wraps to a subtraction
    set[texel] = on;
    for (int dy = -REACH; dy <= REACH; dy++) {
        int row = frame * SIZE + (y + dy + SIZE) % SIZE;
        for (int dx = -REACH; dx <= REACH; dx++)
            energy[row * SIZE + (x + dx + SIZE) % SIZE] +=
                sign * ((kernel[REACH + dx] * kernel[REACH + dy]) >> 4);
        search_row(row);
    }
    for (int dt = -REACH; dt <= REACH; dt++) {
        int row = (frame + dt + FRAMES) % FRAMES * SIZE + y;
        if (dt == 0) continue; // it is in its own slice
        energy[row * SIZE + x] += sign * (kernel[REACH + dt] << 8);
        search_row(row);
    }
}

static int find(const uint32_t *rows, uint32_t value, bool is_set) {
    for (int row = 0; row < ROWS; row++) {
        if (rows[row] != value) continue;
        for (int i = row * SIZE; i < (row + 1) * SIZE; i++)
            if (set[i] == is_set && energy[i] == value) return i;
    }
    abort();
}

static int largest_void(void) {
    uint32_t least = FULL;
    for (int row = 0; row < ROWS; row++) least = emptiest[row] < least ? emptiest[row] : least;
    return find(emptiest, least, false);
}

static int tightest_cluster(void) {
    uint32_t most = 0;
    for (int row = 0; row < ROWS; row++) most = fullest[row] > most ? fullest[row] : most;
    return find(fullest, most, true);
}

// Texels at random, moved from clusters to voids until that changes nothing.
static void make_first(void) {
    uint32_t state = 1;
    for (int done = 0; done < FIRST;) {
        state = state * 747796405u + 2891336453u; // PCG's generator
        int texel = (int)((state >> 8) % COUNT);
        if (set[texel]) continue;
        change(texel, true);
        done++;
    }
    for (int i = 0; i < COUNT; i++) {
        int from = tightest_cluster();
        change(from, false);
        int to = largest_void();
        change(to, true);
        if (from == to) break;
    }
}

// The first texels get their ranks downward, tightest first; the others upward. In the second half
// of the ranks Ulichney looks for the tightest cluster of what is not set: around the edges that is
// the largest void of what is.
static void rank_all(void) {
    static int first[FIRST];
    make_first();
    for (int i = FIRST - 1; i >= 0; i--) {
        first[i] = tightest_cluster();
        rank[first[i]] = (uint32_t)i;
        change(first[i], false);
    }
    for (int i = 0; i < FIRST; i++) change(first[i], true);
    for (int i = FIRST; i < COUNT; i++) {
        int texel = largest_void();
        rank[texel] = (uint32_t)i;
        change(texel, true);
    }
}

typedef struct ranked {
    uint32_t rank;
    int texel;
} ranked;

static int by_rank(const void *a, const void *b) {
    uint32_t left = ((const ranked *)a)->rank, right = ((const ranked *)b)->rank;
    return (left > right) - (left < right);
}

// Every slice holds each of 256 values equally often.
static void write_slice(FILE *file, int frame) {
    static ranked order[SLICE];
    static unsigned value[SLICE];
    for (int i = 0; i < SLICE; i++) order[i] = (ranked){rank[frame * SLICE + i], i};
    qsort(order, SLICE, sizeof *order, by_rank);
    for (int i = 0; i < SLICE; i++) value[order[i].texel] = (unsigned)(i * 256 / SLICE);
    for (int i = 0; i < SLICE; i++) fprintf(file, "%u,%s", value[i], i % 32 == 31 ? "\n" : "");
}

int main(int argc, char **argv) {
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        fprintf(stderr, "usage: make_blue_noise FILE.c\n");
        return 1;
    }
    make_kernel();
    for (int row = 0; row < ROWS; row++) search_row(row);
    rank_all();
    fprintf(file, "#include \"pass/blue_noise.h\"\nconst uint8_t blue_noise_texels[] = {\n");
    for (int frame = 0; frame < FRAMES; frame++) write_slice(file, frame);
    fprintf(file, "};\n");
    bool bad = ferror(file);
    return fclose(file) != 0 || bad ? 1 : 0;
}
