// How long meshes that move take to become cells: no fields, no pictures.
//
//   bench_voxels [-d DEVICE] [-n UPDATES] [-s CELLS] [-t TRIANGLES] [-b BODIES] [-r RULE] [-x]
//
// Bodies are balls with dents that turn and drift within a box of CELLS a side, which one alone
// fills. RULE: 0 auto, 1 solid, 2 shell. -x computes distances too. Prints one line: milliseconds
// of an update by the device's clock, and by the processor time of this process (of interest for a
// software device alone).
#include "scene/voxels.h"
#include "base/error.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BATCH = 20 }; // updates of a frame

typedef struct bench {
    const char *device;
    int updates;
    uint32_t cells, triangles, bodies;
    voxels_rule rule;
    bool distances;
    arena memory;
    gpu *g;
    scene_mesh *meshes;
} bench;

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, err_get());
    return 1;
}

static bool parse(int argc, char **argv, bench *b) {
    *b = (bench){.updates = 50, .cells = 128, .triangles = 20000, .bodies = 1};
    for (int c; (c = getopt(argc, argv, "d:n:s:t:b:r:x")) != -1;) {
        if (c == 'd') b->device = optarg;
        if (c == 'n') b->updates = atoi(optarg);
        if (c == 's') b->cells = (uint32_t)atoi(optarg);
        if (c == 't') b->triangles = (uint32_t)atoi(optarg);
        if (c == 'b') b->bodies = (uint32_t)atoi(optarg);
        if (c == 'r') b->rule = (voxels_rule)atoi(optarg);
        if (c == 'x') b->distances = true;
        if (c == '?') return false;
    }
    return b->updates > 0 && b->bodies > 0;
}

// ---- bodies -----------------------------------------------------------------------------------

static void place_vertex(mesh_vertex *out, float u, float v, bool pole) {
    const float turn = 6.2831853f;
    float ring = pole ? 0 : sinf(turn / 2 * v), r = 0.9f + 0.1f * cosf(5 * turn * u) * ring;
    *out = (mesh_vertex){
        .position = {r * ring * cosf(turn * u), r * ring * sinf(turn * u), r * cosf(turn / 2 * v)}};
}

// About as many triangles as are asked for.
static void make_mesh(bench *b, mesh_data *out) {
    uint32_t rows = (uint32_t)fmax(sqrt(b->triangles / 4.0), 2), around = 2 * rows, count = 0;
    mesh_vertex *vertices = arena_alloc(&b->memory, around * (rows + 1) * sizeof *vertices);
    uint32_t *indices = arena_alloc(&b->memory, 6 * around * rows * sizeof *indices);
    for (uint32_t v = 0; v <= rows; v++)
        for (uint32_t u = 0; u < around; u++)
            place_vertex(&vertices[v * around + u], (float)u / (float)around,
                         (float)v / (float)rows, v == 0 || v == rows);
    for (uint32_t v = 0; v < rows; v++)
        for (uint32_t u = 0; u < around; u++) {
            uint32_t at = v * around + u, next = v * around + (u + 1) % around;
            const uint32_t quad[6] = {at, at + around, next + around, at, next + around, next};
            memcpy(indices + count, quad, sizeof quad);
            count += 6;
        }
    mesh_part *part = arena_alloc(&b->memory, sizeof *part);
    *part = (mesh_part){.count = count, .color = {1, 1, 1, 1}, .texture = -1};
    *out = (mesh_data){.vertices = vertices,
                       .vertex_count = around * (rows + 1),
                       .indices = indices,
                       .index_count = count,
                       .parts = part,
                       .part_count = 1};
}

static const field *moving(bench *b, float3 from, float3 to) {
    const curve_key keys[] = {{0, {from.x, from.y, from.z}}, {1, {to.x, to.y, to.z}}};
    return field_curve(&b->memory, curve_create(&b->memory, &(curve){CURVE_LINEAR, 3, keys, 2, 0}));
}

// In a cube from -1 to 1.
static void place_bodies(bench *b, voxels_body *out) {
    mesh_data data;
    make_mesh(b, &data);
    b->meshes = arena_alloc(&b->memory, b->bodies * sizeof *b->meshes);
    uint32_t side = (uint32_t)ceil(cbrt(b->bodies) - 1e-6);
    float size = 1 / (float)side;
    for (uint32_t i = 0; i < b->bodies; i++) {
        float3 at = {size * (float)(2 * (i % side) + 1) - 1,
                     size * (float)(2 * (i / side % side) + 1) - 1,
                     size * (float)(2 * (i / side / side) + 1) - 1};
        float3 drift = {at.x + 0.05f * size, at.y, at.z};
        b->meshes[i] = (scene_mesh){.name = "ball",
                                    .data = data,
                                    .position = moving(b, at, drift),
                                    .rotation = moving(b, (float3){0}, (float3){90, 50, 20}),
                                    .scale = field_constant(&b->memory, 1, (float[4]){size})};
        out[i] = (voxels_body){&b->meshes[i], b->rule};
    }
}

// ---- measuring --------------------------------------------------------------------------------

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Updates of a frame, from a time on; milliseconds of the device, or a negative number.
static double update(bench *b, voxels *v, gpu_image *image, double time, double step) {
    gpu_pass_time spent = {.milliseconds = -1};
    uint64_t frame = gpu_frame_begin(b->g);
    gpu_pass_begin(b->g, "voxels");
    bool done = true;
    for (int i = 0; i < BATCH && done; i++) {
        voxels_change change;
        field_context context = {.time = time + step * i};
        done = voxels_update(v, b->g, &context, 0.01, &change) &&
               (!image || voxels_write_distance(v, b->g, image));
    }
    gpu_pass_end(b->g);
    if (!gpu_frame_end(b->g) || !done || !gpu_frame_wait(b->g, frame)) return -1;
    return gpu_frame_times(b->g, frame, &spent, 1) == 1 ? spent.milliseconds / BATCH : -1;
}

static int measure(bench *b, voxels *v, gpu_image *image) {
    enum { WARM = 3 };
    double sum = 0, processor = 0;
    for (int i = 0; i < WARM + b->updates; i++) {
        if (i == WARM) processor = processor_seconds();
        const double step = 1.0 / (WARM + b->updates);
        double spent = update(b, v, image, i * step, step / BATCH);
        if (spent < 0) return fail("update");
        if (i >= WARM) sum += spent;
    }
    processor = processor_seconds() - processor;
    printf("%u^3, %u bodies of %u triangles%s: %.4f ms, %.2f ms of the processor\n", b->cells,
           b->bodies, b->meshes[0].data.index_count / 3, image ? ", distances" : "",
           sum / b->updates, 1e3 * processor / b->updates / BATCH);
    return 0;
}

static gpu_image *make_image(bench *b) {
    return gpu_image_create(b->g, &(gpu_image_desc){.label = "distance",
                                                    .format = GPU_R16F,
                                                    .width = b->cells,
                                                    .height = b->cells,
                                                    .depth = b->cells,
                                                    .use = GPU_USE_STORAGE});
}

int main(int argc, char **argv) {
    bench b;
    if (!parse(argc, argv, &b)) return 2;
    const char *source = getenv("ROIL_SOURCE_DIR");
    b.g = gpu_create(&(gpu_desc){.device = b.device});
    if (!b.g) return fail("device");
    shader_library *library = shader_library_create(&(shader_library_desc){
        .shader_root = arena_format(&b.memory, "%s/shaders", source ? source : ".")});
    voxels_body *bodies = arena_alloc(&b.memory, b.bodies * sizeof *bodies);
    place_bodies(&b, bodies);
    voxels_desc desc = {.box = {{-1, -1, -1}, {1, 1, 1}},
                        .size = {b.cells, b.cells, b.cells},
                        .bodies = bodies,
                        .body_count = b.bodies,
                        .distances = b.distances};
    voxels *v = voxels_create(&b.memory, &desc);
    gpu_image *image = b.distances ? make_image(&b) : NULL;
    bool made = v && voxels_build(v, b.g, library, NULL) && voxels_allocate(v, b.g) &&
                (image || !b.distances);
    int status = made ? measure(&b, v, image) : fail("voxels");
    gpu_image_destroy(b.g, image);
    voxels_destroy(v, b.g);
    shader_library_destroy(library);
    gpu_destroy(b.g);
    arena_free(&b.memory);
    return status;
}
