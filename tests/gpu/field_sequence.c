// Sequences on the GPU: what the shader reads at a point at a time.
#include "../unit/field_build.h"
#include "field_probe.h"

#include "field/sequence.h"
#include "media/vdb.h"
#include <unistd.h>

enum { SIDE = 4, FRAMES = 6 };

static char folder[64];

static const char *in_folder(const char *name) {
    return arena_format(build_memory(), "%s/%s", folder, name);
}

// Frame f: a block of voxels of 1 m from index 0; density 1 + f, velocity (x, y, z) of the voxel.
static void write_frames(void) {
    strcpy(folder, "/tmp/roil-gpu-sequence-XXXXXX");
    if (!mkdtemp(folder)) exit(1);
    for (int f = 0; f < FRAMES; f++) {
        float density[SIDE * SIDE * SIDE], velocity[SIDE * SIDE * SIDE * 3];
        for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
            density[i] = 1 + (float)f;
            velocity[3 * i] = (float)(i % SIDE) + 1;
            velocity[3 * i + 1] = (float)(i / SIDE % SIDE) + 1;
            velocity[3 * i + 2] = (float)(i / SIDE / SIDE) + 1;
        }
        vdb_write_grid grids[] = {
            {.name = "density", .values = density, .components = 1},
            {.name = "heat", .values = density, .components = 1},
            {.name = "vel", .values = velocity, .components = 3},
        };
        for (int i = 0; i < 3; i++) {
            grids[i].size[0] = grids[i].size[1] = grids[i].size[2] = SIDE;
            grids[i].voxel_size = 1;
        }
        if (!vdb_write(in_folder(arena_format(build_memory(), "f%d.vdb", f)), grids, 3)) exit(1);
    }
}

static sequence *open_sequence(sequence_desc desc) {
    desc.pattern = in_folder("f*.vdb");
    sequence *s = sequence_create(build_memory(), &desc);
    gpu_test_ok(s);
    return s;
}

static field *channel(sequence *s, const char *name) {
    int components, first = sequence_channel(s, name, &components);
    if (first < 0) fail_msg("%s", err_get());
    return field_grid_channel(build_memory(), sequence_grid(s), first, components);
}

static void show(gpu *g, sequence *s, double time) {
    field_grid *grid = sequence_grid(s);
    gpu_test_ok(grid->update(grid, g, time));
}

static float look(gpu *g, const field *node, float3 p) {
    float point[1][4] = {{p.x, p.y, p.z}}, out[1][4];
    probe(g, node, &(field_context){0}, (const float(*)[4])point, 1, out);
    return out[0][0];
}

static void every_frame_shows_its_values(void **state) {
    sequence *s = open_sequence((sequence_desc){.fps = 10});
    field *density = channel(s, "density");
    for (int i = 0; i < FRAMES; i++) {
        show(*state, s, i / 10.0);
        assert_true(look(*state, density, (float3){1.5f, 2, 1}) == 1 + (float)i);
    }
    for (int i = FRAMES - 1; i >= 0; i -= 2) { // back again, in jumps
        show(*state, s, i / 10.0);
        assert_true(look(*state, density, (float3){1, 1, 1}) == 1 + (float)i);
    }
    sequence_grid(s)->destroy(sequence_grid(s), *state);
}

static void outside_there_is_nothing(void **state) {
    sequence *s = open_sequence((sequence_desc){.fps = 10});
    field *density = channel(s, "density");
    show(*state, s, 0);
    box3 box;
    assert_true(field_bounds(density, &(field_context){0}, &box));
    assert_true(fabsf(box.min.x + 1) < 1e-5f && fabsf(box.max.z - 4) < 1e-5f);
    assert_true(look(*state, density, (float3){0, 0, 0}) == 1);
    assert_true(fabsf(look(*state, density, (float3){-0.5f, 1, 1}) - 0.5f) < 1e-3f); // fades
    assert_true(look(*state, density, (float3){-1.01f, 1, 1}) == 0);
    assert_true(look(*state, density, (float3){1, 1, 50}) == 0);
    show(*state, s, 10); // clip: after the end
    assert_true(look(*state, density, (float3){1, 1, 1}) == 0);
    assert_true(field_bounds(density, &(field_context){0}, &box));
    assert_true(box3_is_empty(box));
    sequence_grid(s)->destroy(sequence_grid(s), *state);
}

static void neighbouring_frames_blend(void **state) {
    sequence *s = open_sequence((sequence_desc){.fps = 10, .blend = true, .loop = SEQUENCE_REPEAT});
    field *density = channel(s, "density");
    show(*state, s, 0.225);
    assert_true(fabsf(look(*state, density, (float3){1, 1, 1}) - 3.25f) < 2e-3f);
    show(*state, s, 0.55); // the last and the first
    assert_true(fabsf(look(*state, density, (float3){1, 1, 1}) - 3.5f) < 2e-3f);
    show(*state, s, 0.3);
    assert_true(look(*state, density, (float3){1, 1, 1}) == 4);
    sequence_grid(s)->destroy(sequence_grid(s), *state);
}

static void channels_are_packed_and_found_again(void **state) {
    sequence *s = open_sequence((sequence_desc){.fps = 10});
    field *density = channel(s, "density"), *heat = channel(s, "temperature");
    field *velocity = channel(s, "velocity");
    assert_int_equal(velocity->components, 3);
    assert_int_equal(velocity->index, 4); // does not fit beside the two
    show(*state, s, 0.1);
    float3 p = {1, 2, 3};
    assert_true(look(*state, density, p) == 2 && look(*state, heat, p) == 2);
    for (int i = 0; i < 3; i++) {
        field *part = need_field(field_swizzle(build_memory(), velocity,
                                               i == 0   ? "x"
                                               : i == 1 ? "y"
                                                        : "z"));
        assert_true(fabsf(look(*state, part, p) - (float)(i + 2)) < 1e-2f);
    }
    // One fetch serves both numbers; the vector needs another.
    arena memory = {0};
    field *sum = make("add", make("add", density, heat),
                      need_field(field_swizzle(build_memory(), velocity, "x")));
    field_root root = {"sum", sum, 1, ""};
    field_program *program = field_program_create(&memory, &root, 1);
    gpu_test_ok(program);
    const field_texture *textures;
    size_t count = field_program_textures(program, &textures), sampled = 0;
    for (size_t i = 0; i < count; i++) sampled += !textures[i].ranges;
    assert_int_equal(sampled, 2);
    assert_true(fabsf(look(*state, sum, p) - 6) < 1e-2f);
    arena_free(&memory);
    sequence_grid(s)->destroy(sequence_grid(s), *state);
}

static void sampling_modes_agree_at_voxel_centres_or_smooth(void **state) {
    sequence *s = open_sequence((sequence_desc){.fps = 10});
    field *x = need_field(field_swizzle(build_memory(), channel(s, "velocity"), "x"));
    show(*state, s, 0);
    arena memory = {0};
    field_root root = {"probe", x, 1, ""};
    field_program *program = field_program_create(&memory, &root, 1);
    gpu_test_ok(program);
    // Voxel i holds i + 1 along x. 1.25 lies a quarter of the way between two centres.
    float points[2][4] = {{1, 1, 1}, {1.25f, 1, 1}}, out[2][4];
    static const struct {
        shader_define define; // SAMPLING is 0 when no option of the shader defines it
        float between;
    } cases[] = {
        {{"SAMPLING_LINEAR", "0"}, 2.25f},
        {{"SAMPLING_QUASI_CUBIC", "0"}, 2.15625f}, // smoothstep of a quarter
        {{"SAMPLING_CUBIC", "0"}, 2.25f},          // splines keep what is linear
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        probe_program(*state, program, "vec4(field_probe(p))", &cases[i].define,
                      &(field_context){0}, (const float(*)[4])points, 2, out);
        assert_true(fabsf(out[0][0] - 2) < 0.01f);
        assert_true(fabsf(out[1][0] - cases[i].between) < 0.01f);
    }
    arena_free(&memory);
    sequence_grid(s)->destroy(sequence_grid(s), *state);
}

static void palettes_are_read_like_on_the_host(void **state) {
    const palette_stop stops[] = {
        {-2, {0, 0, 1, 0}}, {0, {1, 0, 0, 0.5f}}, {0, {0, 1, 0, 1}}, {3, {4, 2, 1, 1}}};
    const palette_key key = {0, stops, COUNT_OF(stops)};
    const palette *p =
        palette_create(build_memory(), &(palette_desc){.keys = &key, .key_count = 1});
    gpu_test_ok(p);
    field *x = need_field(field_swizzle(build_memory(), make("position", NULL), "x"));
    field *fire = need_field(field_palette(build_memory(), p, x));
    enum { COUNT = 64 };
    float points[COUNT][4] = {{0}}, out[COUNT][4];
    for (int i = 0; i < COUNT; i++) points[i][0] = -3 + 7 * (float)i / COUNT;
    probe(*state, fire, &(field_context){0}, (const float(*)[4])points, COUNT, out);
    for (int i = 0; i < COUNT; i++) {
        float want[4];
        palette_eval(p, 0, points[i][0], want);
        for (int c = 0; c < 4; c++) assert_true(fabsf(out[i][c] - want[c]) < 0.01f);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_frame_shows_its_values),
        cmocka_unit_test(outside_there_is_nothing),
        cmocka_unit_test(neighbouring_frames_blend),
        cmocka_unit_test(channels_are_packed_and_found_again),
        cmocka_unit_test(sampling_modes_agree_at_voxel_centres_or_smooth),
        cmocka_unit_test(palettes_are_read_like_on_the_host),
    };
    write_frames();
    int failed = gpu_test_run(tests, COUNT_OF(tests));
    for (int f = 0; f < FRAMES; f++) unlink(in_folder(arena_format(build_memory(), "f%d.vdb", f)));
    rmdir(folder);
    arena_free(build_memory());
    return failed;
}
