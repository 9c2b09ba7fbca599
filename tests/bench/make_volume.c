// A large sequence of OpenVDB files to play back: a column with a rolling cap, torn by noise, rises
// from a surge that runs out along the ground. A box of SIDE^3 voxels, of which a few of a hundred
// are active; density and temperature, halves.
//
//   make_volume FOLDER [SIDE [FRAMES]]     (512, 48; a frame takes 4 SIDE^3 bytes of memory twice)
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/worker.h"
#include "field/noise.h"
#include "media/vdb.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct frame {
    char path[PATH_CAP];
    uint32_t side;
    float age; // 0..1
    bool done;
    char message[512];
} frame;

static float torus(float3 p, float height, float ring, float thick) {
    float out = sqrtf(p.x * p.x + p.y * p.y) - ring, up = p.z - height;
    return sqrtf(out * out + up * up) - thick;
}

// Distance to the cloud (m) before it is torn; the box reaches from -1 to 1, and from 0 to 2.
static float shape(float3 p, float age, float *heat) {
    float height = 0.3f + 1.35f * age, ring = 0.16f + 0.3f * age, thick = 0.1f + 0.1f * age;
    float cap = torus(p, height, ring, thick);
    float across = sqrtf(p.x * p.x + p.y * p.y),
          waist = 0.05f + 0.03f * age + 0.1f * expf(-8 * p.z);
    float stem = fmaxf(across - waist, p.z - height);
    float surge = torus(p, 0.02f, 0.2f + 0.75f * age, 0.05f);
    *heat = expf(-2.5f * age) * clampf(-cap / thick + 0.3f, 0, 1);
    return fminf(fminf(cap, stem), surge);
}

static float torn(float3 p, float age, float *heat) {
    const float reach = 0.1f;
    float d = shape(p, age, heat);
    if (d > reach) return 0;
    const noise_desc large = {.frequency = 7,
                              .octaves = 4,
                              .persistence = 0.55f,
                              .lacunarity = 2.1f,
                              .seed = 3,
                              .amplitude = 1,
                              .phase = age * 1.5f,
                              .four = true,
                              .drift = {0, 0, -2 * age}};
    float n = noise_eval(NOISE_PERLIN, &large, p);
    d += reach * (3 * n - 1.5f);
    if (d > 0) return 0;
    const noise_desc fine = {.frequency = 40,
                             .octaves = 2,
                             .persistence = 0.5f,
                             .lacunarity = 2,
                             .seed = 9,
                             .amplitude = 1};
    float density = fminf(1, -d / 0.04f) * (0.3f + noise_eval(NOISE_PERLIN, &fine, p));
    return density > 0.02f ? density : 0;
}

static void fill(const frame *f, float *density, float *heat) {
    uint32_t side = f->side;
    float voxel = 2 / (float)side;
    size_t at = 0;
    for (uint32_t z = 0; z < side; z++)
        for (uint32_t y = 0; y < side; y++)
            for (uint32_t x = 0; x < side; x++, at++) {
                float3 p = {((float)x + 0.5f) * voxel - 1, ((float)y + 0.5f) * voxel - 1,
                            ((float)z + 0.5f) * voxel};
                float warmth;
                density[at] = torn(p, f->age, &warmth);
                if (density[at] > 0) heat[at] = 300 + 1700 * warmth;
            }
}

static void make(void *user) {
    frame *f = user;
    size_t count = (size_t)f->side * f->side * f->side;
    vdb_write_grid grids[2] = {{.name = "density"}, {.name = "temperature"}};
    float *values[2];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) grids[i].size[k] = f->side;
        grids[i].values = values[i] = mem_alloc(count * sizeof *values[i]);
        grids[i].components = 1;
        grids[i].voxel_size = 2 / (float)f->side;
        grids[i].origin = (float3){grids[i].voxel_size / 2 - 1, grids[i].voxel_size / 2 - 1,
                                   grids[i].voxel_size / 2};
        grids[i].half = true;
        grids[i].grid_class = VDB_FOG;
    }
    fill(f, values[0], values[1]);
    f->done = vdb_write(f->path, grids, 2);
    if (!f->done) snprintf(f->message, sizeof f->message, "%s", err_get());
    for (int i = 0; i < 2; i++) mem_free(values[i]);
}

int main(int argc, char **argv) {
    uint32_t side = argc > 2 ? (uint32_t)atoi(argv[2]) : 512;
    uint32_t count = argc > 3 ? (uint32_t)atoi(argv[3]) : 48;
    if (argc < 2 || side < 16 || side > 1024 || count < 1 || count > 1000) {
        fprintf(stderr, "make_volume FOLDER [SIDE 16..1024 [FRAMES 1..1000]]\n");
        return EXIT_FAILURE;
    }
    frame *frames = mem_alloc(count * sizeof *frames);
    worker *threads = worker_create((size_t)sysconf(_SC_NPROCESSORS_ONLN));
    for (uint32_t i = 0; i < count; i++) {
        char name[32];
        snprintf(name, sizeof name, "cloud_%03u.vdb", i + 1);
        frames[i].side = side;
        frames[i].age = count > 1 ? (float)i / (float)(count - 1) : 1;
        if (!path_join(frames[i].path, argv[1], name)) return EXIT_FAILURE;
        if (i == 0 && !file_make_parent_folders(frames[i].path)) return EXIT_FAILURE;
        worker_submit(threads, (worker_job){make, &frames[i]});
    }
    worker_destroy(threads);
    int failed = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (frames[i].done) continue;
        fprintf(stderr, "make_volume: %s\n", frames[i].message);
        failed = 1;
    }
    mem_free(frames);
    return failed;
}
