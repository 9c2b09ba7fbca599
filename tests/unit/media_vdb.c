// OpenVDB: what a file says about space and values is what comes out, on the lattice and off it.
#include "media_test.h"

#include "media/vdb.h"
#include "media/vdb_layout.h"
#include <math.h>

enum { NX = 10, NY = 5, NZ = 6, COUNT = NX * NY * NZ };

static arena memory;
static float values[COUNT * 3], out[64 * 64 * 64];

static float ramp(float x, float y, float z) {
    return 1.0f + x + 10.0f * y + 100.0f * z;
}

static void fill_ramp(void) {
    for (int z = 0; z < NZ; z++)
        for (int y = 0; y < NY; y++)
            for (int x = 0; x < NX; x++)
                values[(z * NY + y) * NX + x] = ramp((float)x, (float)y, (float)z);
}

static void write_ramp(const char *path, float voxel, float3 origin, bool half) {
    fill_ramp();
    vdb_write_grid grid = {.name = "density",
                           .size = {NX, NY, NZ},
                           .values = values,
                           .components = 1,
                           .voxel_size = voxel,
                           .origin = origin,
                           .half = half,
                           .grid_class = VDB_FOG};
    assert_true(vdb_write(path, &grid, 1));
}

// Also as sequences ask, of two files at once, of which the first is not this one.
static vdb_info info_of(const char *path) {
    vdb_info info, both[2];
    arena *const memories[] = {&memory, &memory};
    const char *paths[] = {test_path("first.vdb"), path};
    arena_free(&memory);
    if (!file_exists(paths[0])) paths[0] = path;
    if (!vdb_read_info(path, &memory, &info)) fail_msg("%s", err_get());
    if (!vdb_read_infos(NULL, paths, 2, memories, both)) fail_msg("%s", err_get());
    assert_int_equal(both[1].count, info.count);
    assert_int_equal(both[1].y_up, info.y_up);
    for (size_t i = 0; i < info.count; i++) {
        const vdb_grid_info *one = &info.grids[i], *other = &both[1].grids[i];
        assert_string_equal(one->name, other->name);
        assert_string_equal(one->type, other->type);
        assert_int_equal(one->components, other->components);
        assert_int_equal(one->grid_class, other->grid_class);
        assert_int_equal(one->active_voxels, other->active_voxels);
        assert_memory_equal(&one->box, &other->box, sizeof one->box);
        assert_memory_equal(one->voxel_size, other->voxel_size, sizeof one->voxel_size);
        assert_memory_equal(one->index_min, other->index_min, sizeof one->index_min);
        assert_memory_equal(one->index_max, other->index_max, sizeof one->index_max);
        assert_memory_equal(one->background, other->background, sizeof one->background);
        assert_int_equal(one->linear, other->linear);
        assert_int_equal(one->sheared, other->sheared);
    }
    return info;
}

static bool sample(const char *path, const char *grid, box3 box, uint32_t x, uint32_t y,
                   uint32_t z) {
    vdb_sample_desc desc = {path, grid, box, {x, y, z}, 1, out, NULL, VDB_SET_SOLID};
    return vdb_sample(&desc, NULL);
}

static float3 vec(float x, float y, float z) {
    return (float3){x, y, z};
}

static void info_says_what_was_written(void **state) {
    (void)state;
    write_ramp(test_path("a.vdb"), 0.5f, vec(10, 20, 30), true);
    vdb_info info = info_of(test_path("a.vdb"));
    assert_int_equal(info.count, 1);
    const vdb_grid_info *g = &info.grids[0];
    assert_string_equal(g->name, "density");
    assert_string_equal(g->type, "half");
    assert_int_equal(g->components, 1);
    assert_int_equal(g->grid_class, VDB_FOG);
    assert_true(g->saved_half && g->linear && g->axis_aligned);
    assert_int_equal(g->active_voxels, COUNT);
    assert_float_equal(g->voxel_size[1], 0.5f, 0);
    assert_non_null(strstr(info.metadata, "creator = roil"));
}

static void the_box_reaches_half_a_voxel_beyond_the_centres(void **state) {
    (void)state;
    write_ramp(test_path("a.vdb"), 0.5f, vec(10, 20, 30), false);
    box3 box = info_of(test_path("a.vdb")).grids[0].box;
    assert_float_equal(box.min.x, 9.75f, 0);
    assert_float_equal(box.min.y, 19.75f, 0);
    assert_float_equal(box.min.z, 29.75f, 0);
    assert_float_equal(box.max.x, 9.75f + 0.5f * NX, 0);
    assert_float_equal(box.max.y, 19.75f + 0.5f * NY, 0);
    assert_float_equal(box.max.z, 29.75f + 0.5f * NZ, 0);
}

static void the_file_says_what_it_was_told(void **state) {
    (void)state;
    fill_ramp();
    vdb_write_grid grid = {.name = "density",
                           .size = {NX, NY, NZ},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1};
    const vdb_entry entries[] = {{.key = "effect", .text = "puff"}, {.key = "time", .number = 1.5}};
    assert_true(vdb_write_with(test_path("a.vdb"), &grid, 1, entries, 2));
    const char *metadata = info_of(test_path("a.vdb")).metadata;
    assert_non_null(strstr(metadata, "effect = puff\n"));
    assert_non_null(strstr(metadata, "time = 1.5\n"));
}

// Two of four halves a voxel are not written; what is near the background is left out, and what is
// not is as it was.
static void halves_are_written_but_for_what_is_next_to_nothing(void **state) {
    (void)state;
    enum { N = 20 };
    static uint16_t halves[N * N * N * 4];
    memset(halves, 0, sizeof halves);
    for (int i = 0; i < N * N * N; i++) {
        bool inside = i % N >= 16;
        halves[i * 4] = half_from_float(inside ? 0.3f + 0.001f * (float)(i % 7) : 0.009f);
        halves[i * 4 + 3] = half_from_float(1000);
    }
    vdb_write_grid grid = {.name = "density",
                           .size = {N, N, N},
                           .halves = halves,
                           .stride = 4,
                           .components = 1,
                           .voxel_size = 1,
                           .half = true,
                           .tolerance = 0.01f,
                           .grid_class = VDB_FOG};
    assert_true(vdb_write(test_path("h.vdb"), &grid, 1));
    const vdb_grid_info *info = &info_of(test_path("h.vdb")).grids[0];
    assert_int_equal(info->active_voxels, 4 * N * N);
    assert_int_equal(info->index_min[0], 16);
    box3 box = {vec(-0.5f, -0.5f, -0.5f), vec(N - 0.5f, N - 0.5f, N - 0.5f)};
    assert_true(sample(test_path("h.vdb"), "density", box, N, N, N));
    for (int i = 0; i < N * N * N; i++) {
        float wanted = i % N >= 16 ? half_to_float(halves[i * 4]) : 0;
        assert_float_equal(out[i], wanted, 0);
    }
}

static void values_are_exact_on_the_lattice(void **state) {
    (void)state;
    write_ramp(test_path("a.vdb"), 0.1f, vec(-3.3f, 0.7f, 2), false);
    box3 box = info_of(test_path("a.vdb")).grids[0].box;
    assert_true(sample(test_path("a.vdb"), "density", box, NX, NY, NZ));
    assert_memory_equal(out, values, COUNT * sizeof *out);
}

static void a_larger_box_shows_the_background(void **state) {
    (void)state;
    fill_ramp();
    vdb_write_grid grid = {.name = "d",
                           .size = {NX, NY, NZ},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1,
                           .background = -4.0f,
                           .grid_class = VDB_FOG};
    assert_true(vdb_write(test_path("b.vdb"), &grid, 1));
    assert_float_equal(info_of(test_path("b.vdb")).grids[0].background[0], -4.0f, 0);
    box3 box = {vec(-2.5f, -0.5f, -0.5f), vec(11.5f, 4.5f, 5.5f)}; // two voxels more at both ends
    assert_true(sample(test_path("b.vdb"), "d", box, NX + 4, NY, NZ));
    for (int x = 0; x < NX + 4; x++) {
        bool inside = x >= 2 && x < NX + 2;
        assert_float_equal(out[x], inside ? ramp((float)(x - 2), 0, 0) : -4.0f, 0);
    }
}

static void a_linear_field_is_exact_off_the_lattice(void **state) {
    (void)state;
    write_ramp(test_path("a.vdb"), 0.5f, vec(0, 0, 0), false);
    // Centres at index 1.25 + 0.75 i, well inside.
    box3 box = {vec(0.4375f, 0.4375f, 0.4375f),
                vec(0.4375f + 4 * 0.375f, 0.4375f + 2 * 0.375f, 0.4375f + 3 * 0.375f)};
    assert_true(sample(test_path("a.vdb"), "density", box, 4, 2, 3));
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 2; y++)
            for (int x = 0; x < 4; x++) {
                float wanted = ramp(1.25f + 0.75f * (float)x, 1.25f + 0.75f * (float)y,
                                    1.25f + 0.75f * (float)z);
                assert_float_equal(out[(z * 2 + y) * 4 + x], wanted, 1e-4f * wanted);
            }
}

static void vectors_come_back_in_order(void **state) {
    (void)state;
    for (int i = 0; i < COUNT * 3; i++) values[i] = (float)i - 100.0f;
    vdb_write_grid grid = {
        .name = "v", .size = {NX, NY, NZ}, .values = values, .components = 3, .voxel_size = 1.0f};
    assert_true(vdb_write(test_path("v.vdb"), &grid, 1));
    vdb_info info = info_of(test_path("v.vdb"));
    assert_int_equal(info.grids[0].components, 3);
    assert_string_equal(info.grids[0].type, "vec3s");
    vdb_sample_desc desc = {test_path("v.vdb"), "v", info.grids[0].box, {NX, NY, NZ}, 3, out, NULL,
                            VDB_SET_SOLID};
    assert_true(vdb_sample(&desc, NULL));
    assert_memory_equal(out, values, COUNT * 3 * sizeof *out);
    desc.components = 1;
    assert_false(vdb_sample(&desc, NULL));
    assert_message("3 component");
}

static void level_sets_become_fog(void **state) {
    (void)state;
    enum { SIDE = 24 };
    const float radius = 0.7f, voxel = 0.1f, band = 0.3f;
    static float distance[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        float x = (float)(i % SIDE) - 12.0f, y = (float)(i / SIDE % SIDE) - 12.0f,
              z = (float)(i / SIDE / SIDE) - 12.0f;
        float d = sqrtf(x * x + y * y + z * z) * voxel - radius;
        distance[i] = fminf(fmaxf(d, -band), band);
    }
    vdb_write_grid grid = {.name = "s",
                           .size = {SIDE, SIDE, SIDE},
                           .values = distance,
                           .components = 1,
                           .voxel_size = voxel,
                           .background = band,
                           .grid_class = VDB_LEVEL_SET};
    assert_true(vdb_write(test_path("s.vdb"), &grid, 1));
    assert_int_equal(info_of(test_path("s.vdb")).grids[0].grid_class, VDB_LEVEL_SET);
    box3 box = {vec(-0.05f, -0.05f, -0.05f), vec(2.35f, 2.35f, 2.35f)};
    assert_true(sample(test_path("s.vdb"), "s", box, SIDE, SIDE, SIDE));
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        float wanted = distance[i] <= 0.0f ? 1.0f : 1.0f - distance[i] / band;
        assert_float_equal(out[i], wanted, 1e-5f);
    }
    assert_float_equal(out[0], 0.0f, 0);
    assert_float_equal(out[(12 * SIDE + 12) * SIDE + 12], 1.0f, 0);
    vdb_sample_desc desc = {test_path("s.vdb"), "s", box, {SIDE, SIDE, SIDE}, 1, out, NULL,
                            VDB_SET_FOG};
    assert_true(vdb_sample(&desc, NULL));
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        float wanted = distance[i] >= 0.0f ? 0.0f : -distance[i] / band;
        assert_float_equal(out[i], wanted, 1e-5f);
    }
}

static void what_is_not_finite_becomes_zero_and_is_counted(void **state) {
    (void)state;
    fill_ramp();
    values[0] = NAN;
    values[7] = INFINITY;
    values[8] = -INFINITY;
    vdb_write_grid grid = {.name = "n",
                           .size = {NX, NY, NZ},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1,
                           .grid_class = VDB_FOG};
    assert_true(vdb_write(test_path("n.vdb"), &grid, 1));
    uint64_t bad = 0;
    vdb_sample_desc desc = {test_path("n.vdb"),
                            "n",
                            {vec(-0.5f, -0.5f, -0.5f), vec(9.5f, 4.5f, 5.5f)},
                            {NX, NY, NZ},
                            1,
                            out,
                            NULL,
                            VDB_SET_SOLID};
    assert_true(vdb_sample(&desc, &bad));
    assert_int_equal(bad, 3);
    assert_float_equal(out[0], 0.0f, 0);
    assert_float_equal(out[1], 2.0f, 0);
    assert_float_equal(out[7], 0.0f, 0);
    desc.box.max = vec(31.5f, 31.5f, 31.5f);
    desc.size[0] = desc.size[1] = desc.size[2] = 32;
    assert_true(vdb_sample(&desc, &bad));
    assert_int_equal(bad, 3);
    assert_float_equal(out[8], 0.0f, 0);
}

static uint64_t count_leaves(const char *path) { // of its first grid
    arena names = {0};
    vdb_layout l;
    void *data;
    size_t size;
    uint64_t leaves;
    assert_true(file_read(path, 1 << 24, &data, &size));
    assert_true(vdb_layout_read(path, data, size, &names, &l));
    assert_true(vdb_layout_check_tree(&l, &l.grids[0], &leaves));
    arena_free(&names);
    mem_free(data);
    return leaves;
}

// Blender's Cycles takes a grid without leaves for an empty one.
static void equal_values_become_leaves_and_come_back(void **state) {
    (void)state;
    static float ones[32 * 32 * 32];
    for (int i = 0; i < 32 * 32 * 32; i++) ones[i] = 2.0f;
    vdb_write_grid grid = {.name = "t",
                           .size = {32, 32, 32},
                           .values = ones,
                           .components = 1,
                           .voxel_size = 1,
                           .grid_class = VDB_FOG};
    assert_true(vdb_write(test_path("t.vdb"), &grid, 1));
    vdb_info info = info_of(test_path("t.vdb"));
    assert_int_equal(info.grids[0].active_voxels, 32 * 32 * 32);
    assert_int_equal(count_leaves(test_path("t.vdb")), 4 * 4 * 4);
    assert_true(sample(test_path("t.vdb"), "t", info.grids[0].box, 32, 32, 32));
    assert_memory_equal(out, ones, sizeof ones);
}

static void a_missing_grid_lists_the_names(void **state) {
    (void)state;
    fill_ramp();
    vdb_write_grid grids[2] = {{.name = "smoke",
                                .size = {NX, NY, NZ},
                                .values = values,
                                .components = 1,
                                .voxel_size = 1,
                                .grid_class = VDB_FOG},
                               {.name = "heat",
                                .size = {NX, NY, NZ},
                                .values = values,
                                .components = 1,
                                .voxel_size = 1,
                                .grid_class = VDB_FOG}};
    assert_true(vdb_write(test_path("two.vdb"), grids, 2));
    box3 box = {vec(0, 0, 0), vec(1, 1, 1)};
    assert_false(sample(test_path("two.vdb"), "density", box, 4, 4, 4));
    assert_message("no grid named 'density'");
    assert_message("smoke, heat");
}

static const char *corpus(const char *name) {
    char path[256];
    snprintf(path, sizeof path, "tests/fuzz/corpus/fuzz_vdb/%s", name);
    return test_source(path);
}

static float sample_voxel(const char *path, const char *grid, int components, float3 centre,
                          float voxel) {
    float h = 0.5f * voxel;
    vdb_sample_desc desc = {path,
                            grid,
                            {vec(centre.x - h, centre.y - h, centre.z - h),
                             vec(centre.x + h, centre.y + h, centre.z + h)},
                            {1, 1, 1},
                            components,
                            out,
                            NULL,
                            VDB_SET_SOLID};
    if (!vdb_sample(&desc, NULL)) fail_msg("%s", err_get());
    return out[0];
}

static void every_kind_of_number_is_read(void **state) {
    (void)state;
    const char *path = corpus("types.vdb");
    if (!path) skip();
    const float3 at = vec(0.5f, 1.0f, 1.5f), off = vec(0, 0, 0); // voxel (1, 2, 3) of 0.5
    assert_float_equal(sample_voxel(path, "double", 1, at, 0.5f), 1.5f, 0);
    assert_float_equal(sample_voxel(path, "double", 1, off, 0.5f), 0.25f, 0);
    assert_float_equal(sample_voxel(path, "int32", 1, at, 0.5f), 7.0f, 0);
    assert_float_equal(sample_voxel(path, "int32", 1, off, 0.5f), -2.0f, 0);
    assert_float_equal(sample_voxel(path, "int64", 1, at, 0.5f), 1099511627776.0f, 0);
    assert_float_equal(sample_voxel(path, "bool", 1, at, 0.5f), 1.0f, 0);
    assert_float_equal(sample_voxel(path, "vec3d", 3, at, 0.5f), 1.0f, 0);
    assert_float_equal(out[2], 3.0f, 0);
    assert_float_equal(sample_voxel(path, "vec3i", 3, at, 0.5f), 4.0f, 0);
    vdb_info info = info_of(path);
    for (size_t i = 0; i < info.count; i++)
        if (strcmp(info.grids[i].name, "mask") == 0) assert_int_equal(info.grids[i].components, 0);
    assert_false(sample(path, "mask", (box3){off, at}, 1, 1, 1));
    assert_message("type mask");
}

static void tiles_of_all_levels_are_read(void **state) {
    (void)state;
    const char *path = corpus("tiles.vdb");
    if (!path) skip();
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(-0.5f, 0, 0), 0.5f), 7.0f, 0);
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(3.5f, 3.5f, 3.5f), 0.5f), 3.0f, 0);
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(100, 10, 10), 0.5f), 5.0f, 0);
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(2100, 10, 10), 0.5f), 9.0f, 0);
    // Between the tiles of 3 and 5 the background shows; off the lattice as well.
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(30.1f, 2.1f, 2.1f), 0.3f), 0.0f, 0);
    assert_float_equal(sample_voxel(path, "tiles", 1, vec(100.1f, 10.1f, 9.9f), 0.3f), 5.0f, 1e-5f);
}

static void staggered_vectors_move_to_the_centres(void **state) {
    (void)state;
    const char *path = corpus("staggered.vdb");
    if (!path) skip();
    assert_int_equal(info_of(path).grids[0].grid_class, VDB_STAGGERED);
    // Stored at the faces: (x, 2 y, 3 z). At the centre of voxel 2: between faces 2 and 3.
    sample_voxel(path, "vel", 3, vec(1, 1, 1), 0.5f);
    assert_float_equal(out[0], 2.5f, 1e-5f);
    assert_float_equal(out[1], 5.0f, 1e-5f);
    assert_float_equal(out[2], 7.5f, 1e-5f);
}

static void turned_grids_are_read_through_their_transform(void **state) {
    (void)state;
    const char *path = corpus("turned.vdb");
    if (!path) skip();
    vdb_info info = info_of(path);
    assert_true(info.grids[0].linear);
    assert_false(info.grids[0].axis_aligned);
    assert_false(info.grids[0].sheared);
    // Voxels 0..3 of 0.5 are 1; turned by 30 degrees about Z, then moved to (1, 2, 3).
    const float c = 0.8660254f, s = 0.5f;
    for (int i = 0; i < 4; i++) {
        float u = 0.5f * (float)i, w = 0.25f;
        float3 at = vec(1 + c * u - s * w, 2 + s * u + c * w, 3.5f);
        assert_float_equal(sample_voxel(path, "turned", 1, at, 0.01f), 1.0f, 1e-5f);
    }
    assert_float_equal(sample_voxel(path, "turned", 1, vec(0.2f, 4.2f, 3.5f), 0.01f), 0.0f, 0);
    assert_false(info_of(corpus("frustum.vdb")).grids[0].linear);
    assert_false(
        sample(corpus("frustum.vdb"), "frustum", (box3){vec(0, 0, 0), vec(1, 1, 1)}, 2, 2, 2));
    assert_message("frustum");
}

static void shared_trees_have_their_own_transforms(void **state) {
    (void)state;
    const char *path = corpus("instance.vdb");
    if (!path) skip();
    float one = sample_voxel(path, "density", 1, vec(1, 1, 1), 0.5f);
    assert_float_equal(sample_voxel(path, "twin", 1, vec(4, 4, 4), 2.0f), one, 0);
    assert_true(one > 1.0f);
}

static void zlib_and_files_without_boxes_are_read(void **state) {
    (void)state;
    static const char *const NAMES[] = {"float.vdb", "zip_mask.vdb", "no_stats.vdb"};
    write_ramp(test_path("first.vdb"), 1, vec(0, 0, 0), false);
    for (int i = 0; i < 3; i++) {
        const char *path = corpus(NAMES[i]);
        if (!path) skip();
        vdb_info info = info_of(path);
        assert_int_equal(info.grids[0].index_min[0], -3);
        assert_int_equal(info.grids[0].index_max[2], 5);
        assert_int_equal(info.grids[0].active_voxels, COUNT);
        assert_true(sample(path, "density", info.grids[0].box, NX, NY, NZ));
        double sum = 0;
        for (int k = 0; k < COUNT; k++) sum += (double)out[k];
        assert_true(sum == 10593.75);
    }
}

static void an_empty_grid_is_no_error(void **state) {
    (void)state;
    const char *path = corpus("empty.vdb");
    if (!path) skip();
    vdb_info info = info_of(path);
    assert_true(info.grids[0].index_min[0] > info.grids[0].index_max[0]);
    assert_true(box3_is_empty(info.grids[0].box));
    assert_true(sample(path, "empty", (box3){vec(0, 0, 0), vec(1, 1, 1)}, 2, 2, 2));
    assert_float_equal(out[7], 0.0f, 0);
}

// Sums found with pyopenvdb on the same file.
static void the_shipped_explosion_has_its_known_sums(void **state) {
    (void)state;
    const char *path = test_source("effects/data/explosion-32/0030.vdb");
    if (!path) skip();
    static const struct {
        const char *name;
        uint64_t voxels;
        double sum;
    } KNOWN[] = {{"density", 2884, 640.923478},
                 {"flame", 2137, 506.942333},
                 {"temperature", 2789, 3384.37569}};
    vdb_info info = info_of(path);
    assert_int_equal(info.count, 3);
    for (size_t i = 0; i < 3; i++) {
        const vdb_grid_info *g = &info.grids[i];
        size_t k = 0;
        while (strcmp(KNOWN[k].name, g->name) != 0) k++;
        assert_int_equal(g->active_voxels, KNOWN[k].voxels);
        assert_float_equal(g->voxel_size[0], 0.25f, 1e-6f);
        box3 domain = {vec(-0.125f, -0.125f, -0.125f), vec(7.875f, 7.875f, 7.875f)};
        assert_true(sample(path, g->name, domain, 32, 32, 32));
        double sum = 0;
        for (int v = 0; v < 32 * 32 * 32; v++) sum += (double)out[v];
        assert_true(fabs(sum - KNOWN[k].sum) < 1e-6 * KNOWN[k].sum);
    }
}

static int teardown(void **state) {
    arena_free(&memory);
    return test_teardown(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(info_says_what_was_written),
        cmocka_unit_test(the_box_reaches_half_a_voxel_beyond_the_centres),
        cmocka_unit_test(the_file_says_what_it_was_told),
        cmocka_unit_test(halves_are_written_but_for_what_is_next_to_nothing),
        cmocka_unit_test(values_are_exact_on_the_lattice),
        cmocka_unit_test(a_larger_box_shows_the_background),
        cmocka_unit_test(a_linear_field_is_exact_off_the_lattice),
        cmocka_unit_test(vectors_come_back_in_order),
        cmocka_unit_test(level_sets_become_fog),
        cmocka_unit_test(what_is_not_finite_becomes_zero_and_is_counted),
        cmocka_unit_test(equal_values_become_leaves_and_come_back),
        cmocka_unit_test(a_missing_grid_lists_the_names),
        cmocka_unit_test(every_kind_of_number_is_read),
        cmocka_unit_test(tiles_of_all_levels_are_read),
        cmocka_unit_test(staggered_vectors_move_to_the_centres),
        cmocka_unit_test(turned_grids_are_read_through_their_transform),
        cmocka_unit_test(shared_trees_have_their_own_transforms),
        cmocka_unit_test(zlib_and_files_without_boxes_are_read),
        cmocka_unit_test(an_empty_grid_is_no_error),
        cmocka_unit_test(the_shipped_explosion_has_its_known_sums),
    };
    return cmocka_run_group_tests(tests, test_setup, teardown);
}
