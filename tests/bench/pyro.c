// How fast the bare solver of burning gas in src/sim steps: no fields, no pictures.
//
//   bench_pyro [-d DEVICE] [-n STEPS] [-s X[,Y,Z]] [-a upwind|parabolic|reflection] [-h f32|f16]
//   [-c CYCLES] [-l] [-v] [-V]
//   [-g] [-k] [-o] [-r] [-t]
//
// A ball of hot fuel burns in the middle of the lower half. -l: the velocity has half as many cells
// along each axis; -v: with confinement; -V: of
// variable density; -o: with smoke; -r: with turbulence; -g: with a guide of cells four times as
// large; -k: a look of each step is kept; -t: the stages of a step are timed apart. Prints
// milliseconds a step by the device's clock, million cells a second by that, and by the processor
// time of this process.
#include "sim/pyro.h"
#include "base/error.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BATCH = 4, STAGES = 16 }; // steps of a frame

typedef struct bench {
    const char *device;
    int steps;
    bool keep;
    gpu_image *guide;
    pyro_desc desc;
    pyro_numbers numbers;
    gpu_pass_time stages[STAGES];
    int stage_count;
} bench;

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, err_get());
    return 1;
}

static bool parse(int argc, char **argv, bench *b) {
    *b = (bench){.steps = 40,
                 .desc = {.size = {64, 64, 64},
                          .faces = {[4] = PYRO_WALL},
                          .advection = PYRO_PARABOLIC,
                          .precision = PYRO_AUTO}};
    for (int c; (c = getopt(argc, argv, "d:n:s:a:h:c:lvktVgor")) != -1;) {
        uint32_t *s = b->desc.size;
        if (c == 'd') b->device = optarg;
        if (c == 'n') b->steps = atoi(optarg);
        if (c == 's' && sscanf(optarg, "%u,%u,%u", &s[0], &s[1], &s[2]) == 1) s[1] = s[2] = s[0];
        for (int i = 0; c == 'a' && i < PYRO_ADVECTIONS; i++)
            if (strcmp(optarg, pyro_advection_names[i]) == 0) b->desc.advection = (pyro_advection)i;
        if (c == 'h') b->desc.precision = strcmp(optarg, "f16") == 0 ? PYRO_F16 : PYRO_F32;
        if (c == 'c') b->desc.cycles = (uint32_t)atoi(optarg);
        if (c == 'l') b->desc.half_velocity = true;
        if (c == 'v') b->desc.confinement = true;
        if (c == 'V') b->desc.variable_density = true;
        if (c == 'g') b->desc.guide = true;
        if (c == 'o') b->desc.smoke = true;
        if (c == 'r') b->desc.turbulence = true;
        if (c == 'k') b->keep = true;
        if (c == 't') b->desc.timed = true;
        if (c == '?') return false;
    }
    return b->steps > 0;
}

// ---- steps ------------------------------------------------------------------------------------

static void add_stage(bench *b, const gpu_pass_time *time) {
    int i = 0;
    while (i < b->stage_count && strcmp(b->stages[i].label, time->label) != 0) i++;
    if (i == STAGES) return;
    if (i == b->stage_count)
        b->stages[b->stage_count++] = *time;
    else
        b->stages[i].milliseconds += time->milliseconds;
}

// Steps in frames; milliseconds of the device, or a negative number.
static double run(bench *b, pyro *p, gpu *g, int steps) {
    double sum = 0;
    const int batch = b->desc.timed ? 1 : BATCH;
    while (steps > 0) {
        const uint64_t frame = gpu_frame_begin(g);
        gpu_pass_begin(g, "steps");
        for (int i = 0; i < batch && steps > 0; i++, steps--)
            if (!pyro_step(p, g, &b->numbers, b->keep)) return -1;
        gpu_pass_end(g);
        gpu_pass_time times[GPU_MAX_PASSES];
        if (!gpu_frame_end(g) || !gpu_frame_wait(g, frame)) return -1;
        const size_t count = gpu_frame_times(g, frame, times, GPU_MAX_PASSES);
        for (size_t i = 0; i < count; i++) {
            sum += times[i].milliseconds;
            add_stage(b, &times[i]);
        }
    }
    return sum;
}

// A ball of hot fuel, in full precision or half.
static bool begin(const bench *b, pyro *p, gpu *g) {
    const uint32_t *n = pyro_get_desc(p)->size;
    const bool half = pyro_get_desc(p)->precision == PYRO_F16;
    gpu_buffer *buffers[PYRO_STATE_BUFFERS];
    if (!gpu_frame_begin(g) || !pyro_reset(p, g, &b->numbers) || !gpu_frame_end(g) || !gpu_idle(g))
        return false;
    const size_t cells = (size_t)n[0] * n[1] * n[2], size = half ? 8 : 16;
    unsigned char *gas = mem_alloc(cells * size);
    memset(gas, 0, cells * size);
    for (size_t i = 0; i < cells; i++) {
        const size_t brick = i / 512, in = i % 512, nx = n[0] / 8, ny = n[1] / 8;
        const double x = (double)(brick % nx * 8 + in % 8) / n[0] - 0.5;
        const double y = (double)(brick / nx % ny * 8 + in / 8 % 8) / n[1] - 0.5;
        const double z = (double)(brick / (nx * ny) * 8 + in / 64) / n[2] - 0.25;
        if (x * x + y * y + z * z > 0.02) continue;
        // 993 K and half as much fuel as air, as they are packed (shaders/sim/pyro/state.glsl).
        const float full[4] = {0.7049f, 0.1475f, 0, 0};
        const uint16_t halves[4] = {0x39a4, 0x30b9, 0, 0};
        memcpy(gas + i * size, half ? (const void *)halves : full, size);
    }
    pyro_buffers(p, buffers);
    const bool done = gpu_buffer_write(g, buffers[1], 0, gas, cells * size);
    mem_free(gas);
    return done;
}

static double processor_milliseconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static bool look(const bench *b, pyro *p, gpu *g, pyro_report *out) {
    return gpu_frame_begin(g) && pyro_watch(p, g, &b->numbers) && gpu_frame_end(g) && gpu_idle(g) &&
           pyro_read(p, g, out);
}

// Air at rest.
static bool make_guide(bench *b, pyro *p, gpu *g) {
    uint32_t n[3];
    if (!b->desc.guide) return true;
    pyro_find_most_guide_cells(p, n);
    b->guide = gpu_image_create(g, &(gpu_image_desc){.label = "guide",
                                                     .format = GPU_RGBA16F,
                                                     .width = n[0],
                                                     .height = n[1],
                                                     .depth = n[2],
                                                     .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    if (!b->guide || !gpu_frame_begin(g)) return false;
    gpu_image_clear(g, b->guide, (const float[4]){0});
    pyro_set_guide(p, b->guide);
    return gpu_frame_end(g);
}

static int measure(bench *b, pyro *p, gpu *g) {
    if (!make_guide(b, p, g)) return fail("guide");
    if (!begin(b, p, g) || run(b, p, g, 2 * BATCH) < 0) return fail("step");
    b->stage_count = 0;
    memset(b->stages, 0, sizeof b->stages);
    double processor = processor_milliseconds(), milliseconds = run(b, p, g, b->steps);
    processor = processor_milliseconds() - processor;
    pyro_report r;
    if (milliseconds <= 0 || !look(b, p, g, &r)) return fail("step");
    const pyro_desc *d = pyro_get_desc(p);
    const double cells = 1e-3 * d->size[0] * d->size[1] * d->size[2] * b->steps; // thousands
    printf("%ux%ux%u %s %s %u cycles%s%s%s%s%s%s%s: %.3f ms a step, %.2f million cells a second, "
           "%.2f a "
           "processor second, residual %.1e of %.2f m/s, %.0f K\n",
           d->size[0], d->size[1], d->size[2], pyro_advection_names[d->advection],
           d->precision == PYRO_F16 ? "f16" : "f32", d->cycles,
           d->half_velocity ? ", half the velocity" : "", d->confinement ? ", confinement" : "",
           d->variable_density ? ", variable density" : "", d->guide ? ", guided" : "",
           d->smoke ? ", smoke" : "", d->turbulence ? ", turbulence" : "", b->keep ? ", kept" : "",
           milliseconds / b->steps, cells / milliseconds, cells / processor, (double)r.residual,
           (double)r.speed, (double)r.hottest);
    for (int i = 0; i < b->stage_count && d->timed; i++)
        printf("  %-24s %8.3f ms\n", b->stages[i].label, b->stages[i].milliseconds / b->steps);
    return 0;
}

int main(int argc, char **argv) {
    bench b;
    if (!parse(argc, argv, &b)) return 2;
    b.numbers = (pyro_numbers){.dt = 1.0f / 120,
                               .cell = 4.0f / (float)b.desc.size[0],
                               .ambient = 293,
                               .gravity = 9.81f,
                               .confinement = b.desc.confinement ? 4 : 0,
                               .ignition = 553,
                               .burn_time = 0.1f,
                               .heat = 2.8e7f,
                               .oxygen = 3.4f,
                               .molar_mass = 105,
                               .soot_yield = 0.06f,
                               .soot_burn_time = 1,
                               .cooling = 400,
                               .guide_rate = 20,
                               .turbulence = 0.3f,
                               .guide_size = 16 / (float)b.desc.size[0],
                               .expansion = 1};
    const char *source = getenv("ROIL_SOURCE_DIR");
    arena memory = {0};
    gpu *g = gpu_create(&(gpu_desc){.device = b.device});
    if (!g) return fail("device");
    shader_library *library = shader_library_create(&(shader_library_desc){
        .shader_root = arena_format(&memory, "%s/shaders", source ? source : ".")});
    pyro *p = pyro_create(&memory, &b.desc);
    const int status = p && pyro_build(p, g, library, NULL) && pyro_allocate(p, g)
                           ? measure(&b, p, g)
                           : fail("pyro");
    if (p) pyro_destroy(p, g);
    gpu_image_destroy(g, b.guide);
    shader_library_destroy(library);
    gpu_destroy(g);
    arena_free(&memory);
    return status;
}
