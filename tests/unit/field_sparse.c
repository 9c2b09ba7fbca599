// Bricks hold what the dense box holds: every voxel of every file, and every face that neighbours
// share, bit by bit; and they cost what is active, not what the box has.
#include "field_build.h"

#include "base/file.h"
#include "field/sequence_parts.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIDE = VDB_BRICK + 1 };

static char folder[64];

static const char *in_folder(const char *name) {
    return arena_format(build_memory(), "%s/%s", folder, name);
}

static sequence *try_open(const char *path, sequence_desc desc, sequence_storage storage) {
    desc.pattern = path;
    desc.storage = storage;
    return sequence_create(build_memory(), &desc);
}

static void close_sequence(sequence *s) {
    sequence_grid(s)->destroy(sequence_grid(s), NULL);
}

static const uint16_t *brick_texel(const sequence_data *s, const sequence_texels *t, int image,
                                   const uint32_t brick[3], const uint32_t local[3]) {
    static const uint16_t zeros[4];
    const sequence_bricks *bricks = &t->bricks[image];
    uint32_t across[3];
    for (int i = 0; i < 3; i++) across[i] = (s->size[i] + VDB_BRICK - 1) / VDB_BRICK;
    uint32_t place = bricks->index[(brick[2] * across[1] + brick[1]) * across[0] + brick[0]];
    if (place == 0) return zeros;
    uint32_t number = (place & 1023) + (place >> 10 & 1023) * bricks->across +
                      (place >> 20 & 1023) * bricks->across * bricks->across;
    assert_true(number < bricks->count && (place & 1023) < bricks->across);
    size_t at = (local[2] * SIDE + local[1]) * SIDE + local[0];
    return t->images[image] +
           ((size_t)number * SIDE * SIDE * SIDE + at) * (size_t)sequence_texel_width(s, image);
}

static void compare_image(const sequence_data *s, const sequence_texels *dense,
                          const sequence_texels *sparse, int image) {
    size_t width = (size_t)sequence_texel_width(s, image);
    uint32_t b[3], l[3];
    for (b[2] = 0; b[2] * VDB_BRICK < s->size[2]; b[2]++)
        for (b[1] = 0; b[1] * VDB_BRICK < s->size[1]; b[1]++)
            for (b[0] = 0; b[0] * VDB_BRICK < s->size[0]; b[0]++)
                for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
                    l[0] = (uint32_t)(i % SIDE);
                    l[1] = (uint32_t)(i / SIDE % SIDE);
                    l[2] = (uint32_t)(i / SIDE / SIDE);
                    size_t x = b[0] * VDB_BRICK + l[0], y = b[1] * VDB_BRICK + l[1],
                           z = b[2] * VDB_BRICK + l[2];
                    if (x >= s->size[0] || y >= s->size[1] || z >= s->size[2]) continue;
                    const uint16_t *wanted =
                        dense->images[image] + ((z * s->size[1] + y) * s->size[0] + x) * width;
                    const uint16_t *found = brick_texel(s, sparse, image, b, l);
                    if (memcmp(wanted, found, width * sizeof *found) != 0)
                        fail_msg("%s: voxel %zu %zu %zu of image %d", s->name, x, y, z, image);
                }
}

// Of all channels that the file has; returns how many could be read.
static int compare_file(const char *path, sequence_desc desc) {
    sequence *dense = try_open(path, desc, SEQUENCE_DENSE);
    if (!dense) return 0;
    sequence *sparse = try_open(path, desc, SEQUENCE_SPARSE);
    if (!sparse) fail_msg("%s", err_get());
    int read = 0, components, other;
    for (size_t i = 0; i < dense->data->infos[0].count && read < 5; i++) {
        const char *name = dense->data->infos[0].grids[i].name;
        if (sequence_channel(dense, name, &components) < 0) continue;
        assert_true(sequence_channel(sparse, name, &other) >= 0);
        assert_int_equal(components, other);
        read++;
    }
    for (uint32_t frame = 0; read > 0 && (int64_t)frame < sequence_frame_count(dense); frame++) {
        sequence_texels a, b;
        bool can = sequence_decode(dense->data, frame, &a);
        assert_int_equal(sequence_decode(sparse->data, frame, &b), can);
        if (!can) continue;
        assert_memory_equal(&a.active, &b.active, sizeof a.active);
        for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(dense->data, i) > 0; i++)
            compare_image(dense->data, &a, &b, i);
        sequence_texels_free(&a);
        sequence_texels_free(&b);
    }
    close_sequence(dense);
    close_sequence(sparse);
    return read;
}

static void every_known_file_is_the_same(void **state) {
    (void)state;
    const char *data = getenv("ROIL_TEST_DATA") ? getenv("ROIL_TEST_DATA") : ".";
    static const char *const files[] = {"float",  "half",  "instance",  "no_stats", "tiles",
                                        "turned", "types", "staggered", "wide",     "zip_mask"};
    int read = 0;
    for (size_t i = 0; i < COUNT_OF(files); i++) {
        const char *path =
            arena_format(build_memory(), "%s/fuzz/corpus/fuzz_vdb/%s.vdb", data, files[i]);
        for (int turned = 0; turned < 2; turned++)
            read += compare_file(path, (sequence_desc){.y_up = turned, .scale = 0.5f});
    }
    assert_true(read > 20);
}

// ---- random grids -----------------------------------------------------------------------------

static uint32_t seed = 1;
static uint32_t roll(uint32_t below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % below;
}

// Blocks of a constant, of noise, single voxels, and voxels on the borders of bricks.
static void fill(float *values, const uint32_t size[3], int components, float background) {
    size_t count = (size_t)size[0] * size[1] * size[2];
    for (size_t i = 0; i < count * (size_t)components; i++) values[i] = background;
    for (int shape = 0; shape < 9; shape++) {
        uint32_t low[3], high[3], at[3];
        for (int i = 0; i < 3; i++) {
            low[i] = roll(size[i]);
            if (shape % 3 == 2) low[i] = (low[i] + 4) / 8 * 8 % size[i]; // at a border
            high[i] = low[i] + (shape % 3 == 0 ? roll(20) : shape % 3 == 1 ? roll(6) : 0);
            if (high[i] >= size[i]) high[i] = size[i] - 1;
        }
        float constant = (float)roll(100) / 8 - 4;
        for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
            for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
                for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
                    for (int c = 0; c < components; c++) {
                        size_t voxel = ((size_t)at[2] * size[1] + at[1]) * size[0] + at[0];
                        values[voxel * (size_t)components + (size_t)c] =
                            shape % 3 == 0 ? constant : (float)roll(1000) / 97 - 3;
                    }
    }
}

static void write_random(const char *file) {
    static const float backgrounds[] = {0, 0, -2.5f, 1};
    vdb_write_grid grids[3];
    float *values[3];
    for (int i = 0; i < 3; i++) {
        grids[i] = (vdb_write_grid){.name = i == 0   ? "density"
                                            : i == 1 ? "heat"
                                                     : "vel",
                                    .size = {9 + roll(40), 9 + roll(40), 9 + roll(40)},
                                    .components = i == 2 ? 3 : 1,
                                    .voxel_size = 0.25f,
                                    .background = i == 2 ? 0 : backgrounds[roll(4)],
                                    .half = roll(2) == 1,
                                    .grid_class = i == 2 ? VDB_UNKNOWN : VDB_FOG};
        grids[i].origin = (float3){0.25f * (float)roll(20), 0.25f * (float)roll(20), 0};
        if (i == 1 && roll(3) == 0) grids[i].voxel_size = 0.35f; // off the lattice of the first
        if (i == 0 && roll(3) == 0) {
            grids[i].grid_class = VDB_LEVEL_SET;
            grids[i].background = 1.5f;
        }
        uint32_t *size = grids[i].size;
        values[i] =
            mem_alloc((size_t)size[0] * size[1] * size[2] * (size_t)grids[i].components * 4);
        fill(values[i], size, grids[i].components, grids[i].background);
        grids[i].values = values[i];
    }
    if (!vdb_write(in_folder(file), grids, 3)) fail_msg("%s", err_get());
    for (int i = 0; i < 3; i++) mem_free(values[i]);
}

static void random_grids_are_the_same(void **state) {
    (void)state;
    for (int i = 0; i < 24; i++) {
        write_random("r1.vdb");
        write_random("r2.vdb");
        assert_int_equal(
            compare_file(in_folder("r*.vdb"),
                         (sequence_desc){.y_up = i % 2, .level_set = (vdb_set)(i / 2 % 2)}),
            3);
    }
    unlink(in_folder("r1.vdb"));
    unlink(in_folder("r2.vdb"));
}

// ---- bytes ------------------------------------------------------------------------------------

// A shell of noise in a box of `size`^3 voxels.
static void write_shell(const char *file, uint32_t size, float radius, float width) {
    float *values = mem_alloc((size_t)size * size * size * sizeof *values);
    for (size_t i = 0; i < (size_t)size * size * size; i++) {
        float x = (float)(i % size), y = (float)(i / size % size), z = (float)(i / size / size);
        float half = 0.5f * (float)size - 0.5f;
        float d =
            sqrtf((x - half) * (x - half) + (y - half) * (y - half) + (z - half) * (z - half));
        if (fabsf(d - radius) < width) values[i] = (float)(1 + roll(100)) / 100;
    }
    values[0] = values[(size_t)size * size * size - 1] = 1; // the corners of the box
    vdb_write_grid grid = {.name = "density",
                           .size = {size, size, size},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1,
                           .half = true,
                           .grid_class = VDB_FOG};
    if (!vdb_write(in_folder(file), &grid, 1)) fail_msg("%s", err_get());
    mem_free(values);
}

static uint64_t bytes_of(const char *file, bool *sparse, uint64_t *voxels) {
    sequence *s = try_open(in_folder(file), (sequence_desc){0}, SEQUENCE_AUTO);
    if (!s) fail_msg("%s", err_get());
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    uint64_t bytes = sequence_upload_bytes(s->data, &t);
    *sparse = sequence_is_sparse(s);
    *voxels = t.voxels;
    sequence_texels_free(&t);
    close_sequence(s);
    return bytes;
}

static void bytes_follow_what_is_active(void **state) {
    (void)state;
    bool sparse;
    uint64_t small, large, few, many;
    write_shell("a.vdb", 190, 40, 6);
    write_shell("b.vdb", 190, 80, 6);
    few = bytes_of("a.vdb", &sparse, &small);
    assert_true(sparse);
    many = bytes_of("b.vdb", &sparse, &large);
    assert_true(sparse);
    double dense = 192.0 * 192 * 192 * 2;
    assert_true((double)many < 0.5 * dense && (double)few < 0.15 * dense);
    // About four times the voxels in the same box: about four times the bytes, at 2 a voxel in
    // bricks that are more than a third full.
    double a = (double)few / (double)small, b = (double)many / (double)large;
    assert_true(large > 3 * small && a < 8 && b < 8 && b < 1.2 * a);
    unlink(in_folder("a.vdb"));
    unlink(in_folder("b.vdb"));
}

static void small_and_full_grids_stay_dense(void **state) {
    (void)state;
    bool sparse;
    uint64_t voxels;
    write_shell("a.vdb", 60, 20, 2); // few voxels, but a small box
    bytes_of("a.vdb", &sparse, &voxels);
    assert_false(sparse);
    write_shell("a.vdb", 170, 0, 80); // a quarter of the box is full
    uint64_t bytes = bytes_of("a.vdb", &sparse, &voxels);
    assert_false(sparse);
    assert_int_equal(bytes, 172 * 172 * 172 * 2);
    unlink(in_folder("a.vdb"));
}

static void what_is_the_same_is_stored_once(void **state) {
    (void)state;
    enum { N = 64 };
    static float values[N * N * N];
    for (int i = 0; i < N * N * N; i++) values[i] = 3;
    vdb_write_grid grid = {
        .name = "density", .size = {N, N, N}, .values = values, .components = 1, .voxel_size = 1};
    if (!vdb_write(in_folder("a.vdb"), &grid, 1)) fail_msg("%s", err_get());
    sequence *s = try_open(in_folder("a.vdb"), (sequence_desc){0}, SEQUENCE_SPARSE);
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    // 9 bricks along each side, of which the 7 inner ones touch no border.
    assert_int_equal(t.bricks[0].count, 9 * 9 * 9 - 7 * 7 * 7 + 1);
    assert_int_equal(t.voxels, N * N * N);
    sequence_texels_free(&t);
    close_sequence(s);
    unlink(in_folder("a.vdb"));
}

static void a_frame_beyond_the_limit_is_refused(void **state) {
    (void)state;
    write_shell("a.vdb", 60, 20, 4);
    sequence_desc desc = {.max_frame_bytes = 20000};
    sequence *s = try_open(in_folder("a.vdb"), desc, SEQUENCE_SPARSE);
    if (!s) fail_msg("%s", err_get());
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    sequence_texels t;
    assert_false(sequence_decode(s->data, 0, &t));
    assert_non_null(strstr(err_get(), "the limit of a frame"));
    close_sequence(s);
    desc.max_frame_bytes = 1000; // less than the index takes
    assert_null(try_open(in_folder("a.vdb"), desc, SEQUENCE_SPARSE));
    unlink(in_folder("a.vdb"));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_known_file_is_the_same),
        cmocka_unit_test(random_grids_are_the_same),
        cmocka_unit_test(bytes_follow_what_is_active),
        cmocka_unit_test(small_and_full_grids_stay_dense),
        cmocka_unit_test(what_is_the_same_is_stored_once),
        cmocka_unit_test(a_frame_beyond_the_limit_is_refused),
    };
    strcpy(folder, "/tmp/roil-sparse-XXXXXX");
    if (!mkdtemp(folder)) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    rmdir(folder);
    arena_free(build_memory());
    return failed;
}
