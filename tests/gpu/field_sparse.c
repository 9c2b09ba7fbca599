// A sparse sequence is sampled like a dense one of the same files, in every sampling mode.
#include "../unit/field_build.h"
#include "field_probe.h"

#include "field/sequence.h"
#include "media/vdb.h"
#include <unistd.h>

enum { SIDE = 41, FRAMES = 3, POINTS = 4096 };

static char folder[64];

static uint32_t seed = 7;
static float roll(void) {
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / (1 << 24);
}

static const char *file_of(int frame) {
    return arena_format(build_memory(), "%s/f%d.vdb", folder, frame);
}

// Frame f: noise in a ball and a block of a constant, both elsewhere in every frame; single voxels
// on the borders of bricks; velocities in another part. Temperatures have a negative background.
static void write_frame(int f) {
    static float density[SIDE * SIDE * SIDE], heat[SIDE * SIDE * SIDE],
        velocity[SIDE * SIDE * SIDE * 3];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        int x = i % SIDE, y = i / SIDE % SIDE, z = i / SIDE / SIDE;
        int dx = x - 10 - 4 * f, dy = y - 12, dz = z - 20;
        bool ball = dx * dx + dy * dy + dz * dz<36, block = x> 20 && y > 17 + f && z > 12;
        bool lone = x % 8 == 7 && y % 8 == 0 && z % 16 == 7 && x < 16;
        density[i] = ball ? roll() : block ? 0.5f : lone ? 2 : 0;
        heat[i] = ball ? 900 * roll() : -3;
        for (int c = 0; c < 3; c++) velocity[3 * i + c] = y < 9 + f ? roll() - 0.5f : 0;
    }
    vdb_write_grid grids[] = {
        {.name = "density", .values = density, .components = 1},
        {.name = "heat", .values = heat, .components = 1, .background = -3},
        {.name = "vel", .values = velocity, .components = 3},
    };
    for (int i = 0; i < 3; i++) {
        grids[i].size[0] = grids[i].size[1] = grids[i].size[2] = SIDE;
        grids[i].voxel_size = 0.25f;
    }
    if (!vdb_write(file_of(f), grids, 3)) exit(1);
}

typedef struct pair { // the same, dense and sparse
    sequence *sequences[2];
    field *fields[2]; // one vector of all that is read
} pair;

static field *channel(sequence *s, const char *name) {
    int components, first = sequence_channel(s, name, &components);
    if (first < 0) fail_msg("%s", err_get());
    return field_grid_channel(build_memory(), sequence_grid(s), first, components);
}

static pair open_pair(sequence_desc desc) {
    pair p;
    desc.pattern = arena_format(build_memory(), "%s/f*.vdb", folder);
    desc.fps = 10;
    for (int i = 0; i < 2; i++) {
        desc.storage = i ? SEQUENCE_SPARSE : SEQUENCE_DENSE;
        sequence *s = sequence_create(build_memory(), &desc);
        gpu_test_ok(s);
        p.sequences[i] = s;
        field *two = make("vec", channel(s, "density"), channel(s, "temperature"), number(0));
        field *velocity = channel(s, "velocity");
        // So that every channel counts: temperatures are a thousand times larger.
        field *scaled = make("mul", two, vector(1, 0.001f, 1));
        p.fields[i] = make("add", scaled, velocity);
    }
    return p;
}

static void close_pair(gpu *g, const pair *p) {
    for (int i = 0; i < 2; i++) {
        field_grid *grid = sequence_grid(p->sequences[i]);
        grid->destroy(grid, g);
    }
}

static void random_points(const pair *p, float (*points)[4]) {
    box3 box = box3_grow(sequence_grid(p->sequences[0])->box, 0.3f);
    for (int i = 0; i < POINTS; i++) {
        const float at[3] = {box.min.x + roll() * (box.max.x - box.min.x),
                             box.min.y + roll() * (box.max.y - box.min.y),
                             box.min.z + roll() * (box.max.z - box.min.z)};
        for (int c = 0; c < 3; c++) { // every other on centres or on borders of voxels
            points[i][c] = at[c];
            if (i % 2) points[i][c] = roundf(at[c] * 8) / 8;
        }
    }
}

// The hardware rounds where between two texels it looks; elsewhere in a texture, it rounds
// otherwise: 1/256 of a voxel, between values up to 2 apart.
static void compare(gpu *g, const pair *p, const shader_define *define) {
    static float points[POINTS][4], out[2][POINTS][4];
    random_points(p, points);
    for (int i = 0; i < 2; i++) {
        arena memory = {0};
        field_root root = {"probe", p->fields[i], 3, ""};
        field_program *program = field_program_create(&memory, &root, 1);
        gpu_test_ok(program);
        probe_program(g, program, "vec4(field_probe(p), 0)", define, &(field_context){0},
                      (const float(*)[4])points, POINTS, out[i]);
        arena_free(&memory);
    }
    int filled = 0, exact = 0;
    for (int i = 0; i < POINTS; i++)
        for (int c = 0; c < 3; c++) {
            float a = out[0][i][c], b = out[1][i][c];
            filled += a != 0;
            exact += a == b;
            if (!(fabsf(a - b) < 0.025f))
                fail_msg("at %g %g %g: %g, not %g", (double)points[i][0], (double)points[i][1],
                         (double)points[i][2], (double)b, (double)a);
        }
    assert_true(filled > POINTS / 2);
    assert_true(exact > POINTS); // all that is empty or constant, at least
}

static void show(gpu *g, const pair *p, double time) {
    for (int i = 0; i < 2; i++) {
        field_grid *grid = sequence_grid(p->sequences[i]);
        gpu_test_ok(grid->update(grid, g, time));
    }
}

static void frames_are_sampled_alike(void **state) {
    pair p = open_pair((sequence_desc){0});
    static const int order[] = {0, 1, 2, 0, 2, 1};
    for (size_t i = 0; i < COUNT_OF(order); i++) {
        show(*state, &p, order[i] / 10.0);
        compare(*state, &p, NULL);
    }
    close_pair(*state, &p);
}

static void every_sampling_mode_is_alike(void **state) {
    pair p = open_pair((sequence_desc){.y_up = true});
    static const shader_define modes[] = {{"SAMPLING_QUASI_CUBIC", "0"}, {"SAMPLING_CUBIC", "0"}};
    show(*state, &p, 0.1);
    for (size_t i = 0; i < COUNT_OF(modes); i++) compare(*state, &p, &modes[i]);
    close_pair(*state, &p);
}

static void frames_with_other_bricks_blend(void **state) {
    pair p = open_pair((sequence_desc){.blend = true, .loop = SEQUENCE_REPEAT});
    for (int i = 0; i < 3; i++) {
        show(*state, &p, (i + 0.3) / 10.0);
        compare(*state, &p, NULL);
    }
    close_pair(*state, &p);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_sampled_alike),
        cmocka_unit_test(every_sampling_mode_is_alike),
        cmocka_unit_test(frames_with_other_bricks_blend),
    };
    strcpy(folder, "/tmp/roil-gpu-sparse-XXXXXX");
    if (!mkdtemp(folder)) return 1;
    for (int f = 0; f < FRAMES; f++) write_frame(f);
    int failed = gpu_test_run(tests, COUNT_OF(tests));
    for (int f = 0; f < FRAMES; f++) unlink(file_of(f));
    rmdir(folder);
    arena_free(build_memory());
    return failed;
}
