// How fast the bare solver of 2D flow in src/sim steps: no fields, no pictures.
//
//   bench_flow [-d DEVICE] [-n STEPS] [-s X[,Y]] [-z SLICES] [-a semi|mac]
//              [-p multigrid|cg|transform|auto] [-f open|closed|periodic] [-i ITERATIONS] [-e
//              TOLERANCE] [-w SWEEPS] [-o] [-t] [-k]
//
// -o puts two discs in the way, -t blends 40 templates in, -k keeps a look of each step. A plume
// rises from the lower face.
// Prints one line: milliseconds a step by the device's clock, and by the processor time of this
// process (of interest for a software device alone), and what the pressure took in the last step.
#include "sim/flow.h"
#include "base/error.h"
#include "base/memory.h"
#include <math.h>
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
    flow_desc desc;
    flow_numbers numbers;
} bench;

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, err_get());
    return 1;
}

static void set_faces(bench *b, const char *name) {
    const flow_face face = name[0] == 'o'   ? FLOW_OPEN
                           : name[0] == 'p' ? FLOW_PERIODIC
                                            : FLOW_CLOSED;
    for (int i = 0; i < 4; i++) b->desc.faces[i] = face;
    if (face == FLOW_OPEN) b->desc.faces[2] = FLOW_CLOSED;
}

static bool parse(int argc, char **argv, bench *b) {
    *b = (bench){.steps = 200,
                 .desc = {.size = {256, 256},
                          .slices = 1,
                          .faces = {[3] = FLOW_OPEN},
                          .advection = FLOW_MACCORMACK,
                          .solver = FLOW_MULTIGRID,
                          .sources = true}};
    for (int c; (c = getopt(argc, argv, "d:n:s:z:a:p:f:i:e:w:otk")) != -1;) {
        uint32_t *s = b->desc.size;
        if (c == 'd') b->device = optarg;
        if (c == 'n') b->steps = atoi(optarg);
        if (c == 's' && sscanf(optarg, "%u,%u", &s[0], &s[1]) == 1) s[1] = s[0];
        if (c == 'z') b->desc.slices = (uint32_t)atoi(optarg);
        if (c == 'a') b->desc.advection = optarg[0] == 'm' ? FLOW_MACCORMACK : FLOW_SEMI_LAGRANGIAN;
        if (c == 'p')
            b->desc.solver = optarg[0] == 'c'   ? FLOW_CG
                             : optarg[0] == 't' ? FLOW_TRANSFORM
                             : optarg[0] == 'a' ? FLOW_AUTO
                                                : FLOW_MULTIGRID;
        if (c == 'f') set_faces(b, optarg);
        if (c == 'i') b->desc.max_iterations = (uint32_t)atoi(optarg);
        if (c == 'e') b->numbers.tolerance = (float)atof(optarg);
        if (c == 'w') b->desc.sweeps = (uint32_t)atoi(optarg);
        if (c == 'o') b->desc.obstacles = true;
        if (c == 't') b->desc.templates = true;
        if (c == 'k') b->keep = true;
        if (c == '?') return false;
    }
    return b->steps > 0;
}

// ---- what is given ----------------------------------------------------------------------------

static bool write_input(flow *f, gpu *g, const char *slot, const void *data, size_t size) {
    gpu_buffer *buffer = flow_find(f, slot);
    return buffer && gpu_buffer_write(g, buffer, 0, data, size);
}

// A disc of hot dye near the lower face, a radius of 1/16 of the width.
static bool write_sources(const bench *b, flow *f, gpu *g, size_t cells) {
    float(*s)[12] = mem_alloc(cells * sizeof *s);
    const uint32_t *n = b->desc.size;
    for (size_t i = 0; i < cells; i++) {
        const double x = (double)(i % n[0]) / n[0] - 0.5,
                     y = (double)(i / n[0] % n[1]) / n[0] - 0.1;
        if (x * x + y * y > 1.0 / 256) continue;
        s[i][0] = s[i][1] = s[i][4] = s[i][5] = 1;
    }
    const bool done = write_input(f, g, "FlowSources", s, cells * sizeof *s);
    mem_free(s);
    return done;
}

static bool write_obstacles(const bench *b, flow *f, gpu *g, size_t cells) {
    float(*s)[4] = mem_alloc(cells * sizeof *s);
    const uint32_t *n = b->desc.size;
    for (size_t i = 0; i < cells; i++) {
        const double x = fabs((double)(i % n[0]) / n[0] - 0.5) - 0.15;
        const double y = (double)(i / n[0] % n[1]) / n[0] - 0.5;
        s[i][0] = x * x + y * y < 0.01;
    }
    const bool done = write_input(f, g, "FlowObstacles", s, cells * sizeof *s);
    mem_free(s);
    return done;
}

static bool write_templates(const bench *b, flow *f, gpu *g, size_t cells) {
    float(*t)[2] = mem_alloc(cells * sizeof *t);
    const uint32_t *n = b->desc.size;
    for (size_t i = 0; i < cells; i++)
        for (int k = 0; k < 40; k++) {
            const double u = fmod(k * 0.618034, 1), v = fmod(k * 0.754878, 1);
            const double x = ((double)(i % n[0]) / n[0] - u) * 20;
            const double y = ((double)(i / n[0] % n[1]) / n[0] - v) * 20, r = x * x + y * y;
            if (r >= 1) continue;
            t[i][0] = (float)exp(-4 * r);
            t[i][1] = k % 2 ? 0.2f : -0.2f;
        }
    const bool done = write_input(f, g, "FlowTemplates", t, cells * sizeof *t);
    mem_free(t);
    return done;
}

static bool begin(const bench *b, flow *f, gpu *g) {
    const size_t cells = (size_t)b->desc.size[0] * b->desc.size[1] * b->desc.slices;
    if (!gpu_frame_begin(g) || !flow_reset(f, g) || !gpu_frame_end(g) || !gpu_idle(g)) return false;
    return write_sources(b, f, g, cells) &&
           (!b->desc.obstacles || write_obstacles(b, f, g, cells)) &&
           (!b->desc.templates || write_templates(b, f, g, cells));
}

// ---- steps ------------------------------------------------------------------------------------

// Steps in frames; milliseconds of the device, or a negative number.
static double run(const bench *b, flow *f, gpu *g, int steps) {
    double sum = 0;
    while (steps > 0) {
        const uint64_t frame = gpu_frame_begin(g);
        gpu_pass_begin(g, "steps");
        for (int i = 0; i < BATCH && steps > 0; i++, steps--)
            if (!flow_step(f, g, &b->numbers, b->keep)) return -1;
        gpu_pass_end(g);
        gpu_pass_time time;
        if (!flow_watch(f, g) || !gpu_frame_end(g) || !gpu_frame_wait(g, frame)) return -1;
        if (gpu_frame_times(g, frame, &time, 1) == 1) sum += time.milliseconds;
    }
    return sum;
}

static double processor_milliseconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int measure(const bench *b, flow *f, gpu *g) {
    if (!begin(b, f, g) || run(b, f, g, 2 * BATCH) < 0) return fail("step");
    double processor = processor_milliseconds(), milliseconds = run(b, f, g, b->steps);
    processor = processor_milliseconds() - processor;
    flow_report report;
    if (milliseconds <= 0 || !flow_read(f, g, &report)) return fail("step");
    static const char *const solvers[] = {"cg", "multigrid", "transform"};
    const flow_desc *d = flow_get_desc(f);
    printf("%ux%ux%u %s %s%s%s%s: %.3f ms a step, %.3f ms of the processor, %u of %u iterations, "
           "residual %.1e, %.2f m/s\n",
           d->size[0], d->size[1], d->slices,
           d->advection == FLOW_MACCORMACK ? "maccormack" : "semi-lagrangian", solvers[d->solver],
           d->obstacles ? ", obstacles" : "", d->templates ? ", templates" : "",
           b->keep ? ", kept" : "", milliseconds / b->steps, processor / b->steps,
           report.iterations, d->max_iterations, (double)report.residual, (double)report.speed);
    return 0;
}

int main(int argc, char **argv) {
    bench b;
    if (!parse(argc, argv, &b)) return 2;
    b.numbers.dt = 1.0f / 60;
    b.numbers.cell = 2.0f / (float)b.desc.size[0];
    b.numbers.buoyancy[1] = 3;
    b.numbers.decay[1] = 0.5f;
    b.numbers.vorticity = 2;
    b.numbers.viscosity = 1e-4f;
    const char *source = getenv("ROIL_SOURCE_DIR");
    arena memory = {0};
    gpu *g = gpu_create(&(gpu_desc){.device = b.device});
    if (!g) return fail("device");
    shader_library *library = shader_library_create(&(shader_library_desc){
        .shader_root = arena_format(&memory, "%s/shaders", source ? source : ".")});
    flow *f = flow_create(&memory, &b.desc);
    const int status = f && flow_build(f, g, library, NULL) && flow_allocate(f, g)
                           ? measure(&b, f, g)
                           : fail("flow");
    if (f) flow_destroy(f, g);
    shader_library_destroy(library);
    gpu_destroy(g);
    arena_free(&memory);
    return status;
}
