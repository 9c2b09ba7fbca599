// How fast the bare solver of src/sim steps: no fields, no pictures.
//
//   bench_lattice [-d DEVICE] [-n STEPS] [-s X,Y,Z] [-q 19|27] [-p 16|32] [-c SCALARS]
//                 [-o bgk|trt|moments] [-f periodic|wall|slip|open] [-w LANES] [-b] [-k] [-l] [-x]
//
// LANES, 2 or 4, are the cells of an element; -b: without blocks. -k keeps moments in each step; -l
// adds the subgrid term; -x carries scalars on D3Q27. Prints one line: million cell updates a
// second by the device's clock, by the processor time of this process (of interest for a software
// device alone), and the bytes a second that the populations themselves make.
#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "sim/lbm.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BATCH = 20 }; // steps of a frame

typedef struct bench {
    const char *device;
    int steps;
    bool keep;
    lbm_desc desc;
} bench;

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, err_get());
    return 1;
}

static bool parse(int argc, char **argv, bench *b) {
    *b = (bench){.steps = 100, .desc = {.size = {96, 96, 96}, .collision = LBM_CENTRAL_MOMENTS}};
    for (int c; (c = getopt(argc, argv, "d:n:s:q:p:c:o:f:w:bklx")) != -1;) {
        uint32_t *s = b->desc.size;
        if (c == 'd') b->device = optarg;
        if (c == 'n') b->steps = atoi(optarg);
        if (c == 's' && sscanf(optarg, "%u,%u,%u", &s[0], &s[1], &s[2]) == 1) s[1] = s[2] = s[0];
        if (c == 'q') b->desc.set = atoi(optarg) == 27 ? LBM_D3Q27 : LBM_D3Q19;
        if (c == 'p') b->desc.precision = atoi(optarg) == 16 ? LBM_F16 : LBM_F32;
        if (c == 'c') b->desc.scalars = (uint32_t)atoi(optarg);
        if (c == 'o')
            b->desc.collision = optarg[0] == 'b'   ? LBM_BGK
                                : optarg[0] == 't' ? LBM_TRT
                                                   : LBM_CENTRAL_MOMENTS;
        for (int i = 0; c == 'f' && i < 6; i++)
            b->desc.faces[i] = optarg[0] == 'w'   ? LBM_WALL
                               : optarg[0] == 's' ? LBM_SLIP
                               : optarg[0] == 'o' ? LBM_OPEN
                                                  : LBM_PERIODIC;
        if (c == 'b') b->desc.order = LBM_WHOLE;
        if (c == 'w') b->desc.lanes = (uint32_t)atoi(optarg);
        if (c == 'k') b->keep = true;
        if (c == 'x') b->desc.scalar_set = LBM_SCALAR_D3Q27;
        if (c == 'l') b->desc.subgrid = true;
        if (c == '?') return false;
    }
    return b->steps > 0;
}

// Steps in frames; milliseconds of the device, or a negative number.
static double run(const bench *b, lbm *l, gpu *g, int steps) {
    lbm_numbers numbers = {.tau = 0.52f,
                           .scalar_tau = {0.52f, 0.52f, 0.52f},
                           .smagorinsky = 0.1f,
                           .buoyancy = {[1] = {0, 0, 1e-6f}}}; // the second one is heat
    double sum = 0;
    while (steps > 0) {
        uint64_t frame = gpu_frame_begin(g);
        gpu_pass_begin(g, "steps");
        for (int i = 0; i < BATCH && steps > 0; i++, steps--)
            if (!lbm_step(l, g, &numbers, b->keep)) return -1;
        gpu_pass_end(g);
        gpu_pass_time time;
        if (!gpu_frame_end(g) || !gpu_frame_wait(g, frame)) return -1;
        if (gpu_frame_times(g, frame, &time, 1) == 1) sum += time.milliseconds;
    }
    return sum;
}

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int measure(const bench *b, lbm *l, gpu *g) {
    lbm_numbers rest = {.ambient = {0.5f, 0.5f, 0.5f}};
    if (!gpu_frame_begin(g) || !lbm_reset(l, g, &rest) || !gpu_frame_end(g)) return fail("reset");
    if (run(b, l, g, 2 * BATCH) < 0) return fail("step");
    double processor = processor_seconds(), milliseconds = run(b, l, g, b->steps);
    processor = processor_seconds() - processor;
    if (milliseconds <= 0) return fail("step");
    const lbm_desc *d = &b->desc;
    double updates = (double)d->size[0] * d->size[1] * d->size[2] * b->steps;
    double directions = (d->set == LBM_D3Q27 ? 27 : 19) +
                        (d->scalar_set == LBM_SCALAR_D3Q27 ? 27.0 : 7.0) * d->scalars;
    double bytes = 2 * directions * (d->precision == LBM_F16 ? 2 : 4) + (b->keep ? 16 : 0);
    static const char *const faces[] = {"", ", walls", ", slip", ", open"};
    printf("%ux%ux%u %s %s, %u scalars%s%s%s: %.2f million updates/s, %.2f per processor second, "
           "%.1f GB/s\n",
           d->size[0], d->size[1], d->size[2], d->set == LBM_D3Q27 ? "D3Q27" : "D3Q19",
           d->precision == LBM_F16 ? "16 bits" : "32 bits", d->scalars, b->keep ? ", kept" : "",
           d->subgrid ? ", subgrid" : "", faces[d->faces[0]], updates / milliseconds / 1e3,
           updates / processor / 1e6, updates * bytes / milliseconds / 1e6);
    return 0;
}

int main(int argc, char **argv) {
    bench b;
    if (!parse(argc, argv, &b)) return 2;
    const char *source = getenv("ROIL_SOURCE_DIR");
    arena memory = {0};
    gpu *g = gpu_create(&(gpu_desc){.device = b.device});
    if (!g) return fail("device");
    shader_library *library = shader_library_create(&(shader_library_desc){
        .shader_root = arena_format(&memory, "%s/shaders", source ? source : ".")});
    lbm *l = lbm_create(&memory, &b.desc);
    int status = l && lbm_build(l, g, library, NULL) && lbm_allocate(l, g) ? measure(&b, l, g)
                                                                           : fail("lattice");
    if (l) lbm_destroy(l, g);
    shader_library_destroy(library);
    gpu_destroy(g);
    arena_free(&memory);
    return status;
}
