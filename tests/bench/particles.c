// How fast particles move: births and a step of them all, nothing drawn.
//
//   bench_particles [-d DEVICE] [-c COUNT] [-n STEPS] [-m MOTION] [-e]
//
// MOTION: still (a constant), vortex (arithmetic), curl (noise), grid (128^3 voxels of four
// halves), throw (gravity, drag and a ground). -e takes Euler's step. Prints one line: milliseconds
// of a step by the device's clock, million particles a second by it and by the processor time of
// this process (of interest for a software device alone), and the bytes a second of the state
// itself.
#include "pass/particles/particles.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/statistics.h"
#include "effect/effect.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { WARM = 8, MOST_STEPS = 1 << 16 };

typedef struct bench {
    const char *device, *motion;
    uint32_t count, steps;
    bool euler;
    effect *e;
    pass *pass;
} bench;

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, err_get());
    return 1;
}

static bool parse(int argc, char **argv, bench *b) {
    *b = (bench){.count = 1 << 20, .steps = 40, .motion = "vortex"};
    for (int c; (c = getopt(argc, argv, "d:c:n:m:e")) != -1;) {
        if (c == 'd') b->device = optarg;
        if (c == 'c') b->count = (uint32_t)atoi(optarg);
        if (c == 'n') b->steps = (uint32_t)atoi(optarg);
        if (c == 'm') b->motion = optarg;
        if (c == 'e') b->euler = true;
        if (c == '?') return false;
    }
    return b->steps > 0 && b->steps < MOST_STEPS;
}

// ---- fields -----------------------------------------------------------------------------------

static const field *triple(bench *b, float x, float y, float z) {
    return field_constant(effect_memory(b->e), 3, (float[4]){x, y, z});
}

static const field *number(bench *b, float x) {
    return field_constant(effect_memory(b->e), 1, (float[4]){x});
}

static const field *make(bench *b, const char *kind, const field *x, const field *y,
                         const field *z) {
    return field_make(effect_memory(b->e), kind, (const field *[FIELD_MAX_ARGS]){x, y, z}, NULL);
}

static const field *component(bench *b, const char *name) {
    return field_swizzle(effect_memory(b->e), make(b, "position", NULL, NULL, NULL), name);
}

static const field *vortex(bench *b) {
    return make(b, "vec", make(b, "negate", component(b, "y"), NULL, NULL), component(b, "x"),
                number(b, 0));
}

static const field *grid(bench *b) {
    effect_bake_desc desc = {.size = {128, 128, 128}, .box = {{-2, -2, -2}, {2, 2, 2}}};
    field_grid *made = effect_add_bake(b->e, vortex(b), &desc);
    return made ? field_grid_channel(effect_memory(b->e), made, 0, 3) : NULL;
}

static bool set(bench *b, const char *name, float value) {
    return pass_set_uniform(b->pass, name, number(b, value));
}

static bool carry(bench *b, const field *velocity) {
    return velocity && pass_set_field(b->pass, "velocity", velocity);
}

static bool set_motion(bench *b) {
    const char *m = b->motion;
    if (strcmp(m, "still") == 0) return carry(b, triple(b, 0, 0, 0.01f));
    if (strcmp(m, "vortex") == 0) return carry(b, vortex(b));
    if (strcmp(m, "curl") == 0) return carry(b, make(b, "curl", NULL, NULL, NULL));
    if (strcmp(m, "grid") == 0) return carry(b, grid(b));
    if (strcmp(m, "throw") != 0) return err_set("no motion '%s'", m);
    return set(b, "gravity", 9.81f) && set(b, "drag", 0.2f) &&
           pass_set_field(b->pass, "collide", component(b, "z")) &&
           pass_set_field(b->pass, "speed", triple(b, 0, 0, 5));
}

// ---- measuring --------------------------------------------------------------------------------

static bool build(bench *b, gpu *g, shader_library *library, const char *root) {
    b->e = effect_create(&(effect_desc){
        .device = g, .file = "tests/bench/particles.lua", .shader_root = root, .library = library});
    if (!b->e || !effect_set_timeline(b->e, 60, MOST_STEPS, 0)) return false;
    b->pass = effect_add_pass(b->e, "particles", NULL, NULL);
    const pass_particles_desc desc = {.count = b->count, .time_step = 1.0 / 60};
    return b->pass && pass_particles_open(b->pass, &desc) && set_motion(b) &&
           set(b, "burst", (float)b->count) && set(b, "lifetime_min", 1e6f) &&
           set(b, "lifetime_max", 1e6f) && set(b, "radius", 1) &&
           pass_set_option(b->pass, "integrator", b->euler ? "euler" : "rk2") &&
           pass_declare(b->pass) &&
           effect_set_picture(b->e, EFFECT_OUTPUT, pass_output(b->pass, "particles")) &&
           effect_build(b->e, 16, 16);
}

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Of the step in a frame; negative: there was no such time.
static double milliseconds(gpu *g, uint64_t frame) {
    gpu_pass_time times[16];
    size_t count = gpu_frame_times(g, frame, times, COUNT_OF(times));
    for (size_t i = 0; i < count && i < COUNT_OF(times); i++)
        if (strcmp(times[i].label, "particles.step") == 0) return times[i].milliseconds;
    return -1;
}

static int measure(bench *b, gpu *g) {
    double *times = mem_alloc(b->steps * sizeof *times), processor = 0;
    for (uint32_t i = 0; i < WARM + b->steps; i++) {
        if (i == WARM) processor = processor_seconds();
        uint64_t frame = effect_render(b->e, i + 1, false);
        if (!frame || !gpu_frame_wait(g, frame)) return fail("step");
        if (i >= WARM) times[i - WARM] = milliseconds(g, frame);
    }
    processor = processor_seconds() - processor;
    double step = stats_summarise(times, b->steps).median, count = b->count;
    printf("%u particles, %s, %s: %.4f ms a step, %.1f million/s, %.1f per processor second, "
           "%.1f GB/s\n",
           b->count, b->motion, b->euler ? "Euler" : "RK2", step, count / step / 1e3,
           count * b->steps / processor / 1e6, count * 64 / step / 1e6);
    mem_free(times);
    return 0;
}

int main(int argc, char **argv) {
    bench b;
    char root[4096];
    if (!parse(argc, argv, &b)) return 2;
    const char *source = getenv("ROIL_SOURCE_DIR");
    snprintf(root, sizeof root, "%s/shaders", source ? source : ".");
    gpu *g = gpu_create(&(gpu_desc){.device = b.device});
    if (!g) return fail("device");
    shader_library *library = shader_library_create(&(shader_library_desc){.shader_root = root});
    int status = library && build(&b, g, library, root) ? measure(&b, g) : fail("particles");
    if (b.e) effect_destroy(b.e);
    shader_library_destroy(library);
    gpu_destroy(g);
    return status;
}
