// Meshes as cells, held against an exact inside test.
#include "voxels_test.h"

static const box3 around = {{-2, -2, -2}, {2, 2, 2}};
enum { N = 32, CELLS = N * N * N };
static const double edge = 4.0 / N;

static double3 centre_of(int x, int y, int z) {
    return (double3){{-2 + edge * (x + 0.5), -2 + edge * (y + 0.5), -2 + edge * (z + 0.5)}};
}

static uint32_t *voxelise(voxels_world *w, const voxels_body *bodies, size_t count) {
    voxels *v = make_voxels(w, &(voxels_desc){around, {N, N, N}, bodies, count, false});
    update_voxels(w, v, w->context.time, 0);
    uint32_t *ids = read_ids(w, v);
    voxels_destroy(v, w->device);
    return ids;
}

static size_t count_ids(const uint32_t *ids, uint32_t id) {
    size_t count = 0;
    for (size_t i = 0; i < CELLS; i++) count += ids[i] == id;
    return count;
}

// Distance to the nearest corner of six around a point at which the winding number is another: a
// point nearer to the surface than `far` may count either way.
static bool is_at_surface(const double3 *corners, size_t count, double3 p, double far) {
    int here = (int)lrint(winding_at(corners, count, p));
    for (int i = 0; i < 14; i++) {
        static const signed char ways[14][3] = {{1, 0, 0},   {-1, 0, 0},  {0, 1, 0},  {0, -1, 0},
                                                {0, 0, 1},   {0, 0, -1},  {1, 1, 1},  {1, 1, -1},
                                                {1, -1, 1},  {1, -1, -1}, {-1, 1, 1}, {-1, 1, -1},
                                                {-1, -1, 1}, {-1, -1, -1}};
        double3 q = p;
        for (int a = 0; a < 3; a++) q.v[a] += far * ways[i][a];
        if ((int)lrint(winding_at(corners, count, q)) != here) return true;
    }
    return false;
}

// Every cell but those whose centre is within 1/100 of one of the surface.
static void expect_exact(voxels_world *w, const scene_mesh *mesh, const uint32_t *ids,
                         const char *what) {
    size_t count = mesh->data.index_count, inside = 0, skipped = 0;
    double3 *corners = placed_corners(w, mesh);
    for (int i = 0; i < CELLS; i++) {
        int x = i % N, y = i / N % N, z = i / N / N;
        double3 p = centre_of(x, y, z);
        bool want = lrint(winding_at(corners, count, p)) != 0;
        inside += want;
        if ((ids[i] != 0) == want) continue;
        if (!is_at_surface(corners, count, p, 0.01 * edge))
            fail_msg("%s: cell %d %d %d is %d", what, x, y, z, ids[i]);
        skipped++;
    }
    mem_free(corners);
    if (inside < 50 || skipped > inside / 100 + 4)
        fail_msg("%s: %zu cells inside, %zu at the surface otherwise", what, inside, skipped);
}

static void solids_hold_the_centres_that_they_hold(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    for (int i = 0; i < 9; i++) {
        shape s = {0};
        if (i % 3 == 0) shape_box(&s, (float3){-1, -0.7f, -0.4f}, (float3){0.9f, 0.8f, 0.5f});
        if (i % 3 == 1) shape_sphere(&s, 8);
        if (i % 3 == 2) shape_round(&s, 16, 8, false, on_torus);
        scene_mesh *mesh = shape_mesh(&w, &s);
        if (i >= 3) {
            mesh->position = triple(&w, 0.11f, -0.23f, 0.31f);
            mesh->rotation = triple(&w, 31, -47, 113);
            mesh->scale = number(&w, 1.23f);
        }
        if (i >= 6) { // most of it outside of the box, and mirrored
            mesh->position = triple(&w, -1.6f, 1.5f, 1.2f);
            mesh->scale = number(&w, -1.5f);
        }
        voxels_rule rule = i % 3 == 2 ? VOXELS_SOLID : VOXELS_AUTO;
        uint32_t *ids = voxelise(&w, &(voxels_body){mesh, rule}, 1);
        assert_true(count_ids(ids, 1) + count_ids(ids, 0) == CELLS);
        char what[16];
        snprintf(what, sizeof what, "shape %d", i);
        expect_exact(&w, mesh, ids, what);
        mem_free(ids);
    }
    voxels_close(&w);
}

// ---- ties, holes, sheets ------------------------------------------------------------------------

// Faces through centres: a body holds the centres where it begins, not those where it ends.
static void centres_on_faces_edges_and_corners_count_once(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    float h = (float)edge / 2;
    shape_box(&s, (float3){-1 + h, -1 + h, -1 + h}, (float3){1 + h, 1 + h, 1 + h});
    // Triangles that meet in centres: an octahedron with its corners there.
    shape o = {0};
    for (int i = 0; i < 6; i++) {
        float side = i % 2 ? -1 : 1;
        shape_vertex(&o, h + (i / 2 == 0 ? side : 0), h + (i / 2 == 1 ? side : 0),
                     h + (i / 2 == 2 ? side : 0));
    }
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
        bool odd = (i & 1) ^ (i >> 1 & 1) ^ (i >> 2);
        shape_triangle(&o, x, odd ? z : y, odd ? y : z);
    }
    uint32_t *ids = voxelise(&w, &(voxels_body){shape_mesh(&w, &s), VOXELS_SOLID}, 1);
    for (int i = 0; i < CELLS; i++) {
        int x = i % N, y = i / N % N, z = i / N / N;
        bool want = x >= 8 && x < 24 && y >= 8 && y < 24 && z >= 8 && z < 24;
        if ((ids[i] != 0) != want) fail_msg("cell %d %d %d", x, y, z);
    }
    mem_free(ids);
    ids = voxelise(&w, &(voxels_body){shape_mesh(&w, &o), VOXELS_SOLID}, 1);
    for (int i = 0; i < CELLS; i++) { // centres on the surface may count either way
        int x = i % N - 16, y = i / N % N - 16, z = i / N / N - 16;
        int far = abs(x) + abs(y) + abs(z);
        if (far != 8 && (ids[i] != 0) != (far < 8)) fail_msg("cell %d %d %d: %d", x, y, z, ids[i]);
    }
    mem_free(ids);
    voxels_close(&w);
}

static void hole_leaves_no_streak(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_sphere(&s, 12);
    scene_mesh *whole = shape_mesh(&w, &s);
    scene_mesh torn = *whole;
    torn.data.index_count -= 3 * 2 * 24; // its lowest band
    uint32_t *want = voxelise(&w, &(voxels_body){whole, VOXELS_SOLID}, 1);
    uint32_t *ids = voxelise(&w, &(voxels_body){&torn, VOXELS_SOLID}, 1);
    for (int i = 0; i < CELLS; i++)
        if (ids[i] != want[i] && i / N / N >= 10) fail_msg("cell %d", i);
    assert_true(count_ids(ids, 1) + 10 > count_ids(want, 1));
    mem_free(ids);
    ids = voxelise(&w, &(voxels_body){&torn, VOXELS_AUTO}, 1); // its shell then
    assert_int_equal(ids[16 + N * 16 + N * N * 16], 0);
    assert_true(count_ids(ids, 1) > 500);
    mem_free(ids);
    mem_free(want);
    voxels_close(&w);
}

// Filled from a corner over all 26 neighbours, does the outside reach this cell?
static bool floods(const uint32_t *ids, int target) {
    bool *seen = mem_alloc(CELLS);
    int *list = mem_alloc(CELLS * sizeof *list), count = 1;
    seen[0] = true;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 27; k++) {
            int x = list[i] % N + k % 3 - 1, y = list[i] / N % N + k / 3 % 3 - 1;
            int z = list[i] / N / N + k / 9 - 1, at = x + N * (y + N * z);
            if (x < 0 || y < 0 || z < 0 || x >= N || y >= N || z >= N) continue;
            if (seen[at] || ids[at]) continue;
            seen[at] = true;
            list[count++] = at;
        }
    }
    bool reached = seen[target];
    mem_free(seen);
    mem_free(list);
    return reached;
}

// A hollow box, 2 m wide; closed, or with `shell` only its outside.
static scene_mesh *hollow_box(voxels_world *w, float wall, bool shell, const float rotation[3]) {
    shape s = {0};
    shape_box(&s, (float3){-1, -1, -1}, (float3){1, 1, 1});
    size_t inner = s.index_count;
    shape_box(&s, (float3){wall - 1, wall - 1, wall - 1}, (float3){1 - wall, 1 - wall, 1 - wall});
    for (size_t k = inner; k < s.index_count; k += 3) { // turned inside out
        uint32_t swap = s.indices[k];
        s.indices[k] = s.indices[k + 1];
        s.indices[k + 1] = swap;
    }
    if (shell) s.index_count = inner;
    scene_mesh *mesh = shape_mesh(w, &s);
    mesh->rotation = triple(w, rotation[0], rotation[1], rotation[2]);
    return mesh;
}

static bool leaks(voxels_world *w, const scene_mesh *mesh, voxels_rule rule) {
    int middle = N / 2 * (1 + N + N * N);
    uint32_t *ids = voxelise(w, &(voxels_body){mesh, rule}, 1);
    assert_int_equal(ids[middle], 0);
    assert_int_equal(ids[0], 0);
    size_t cells = count_ids(ids, 1);
    if (cells > 8000) fail_msg("%zu cells", cells);
    bool leak = floods(ids, middle);
    mem_free(ids);
    return leak;
}

// Hardly any centre is in walls of 1/4 of a cell; those of 1.2 cells are closed along the axes and
// have gaps across.
static void thin_walls_and_shells_let_nothing_through(void **state) {
    static const float rotations[][3] = {{0, 0, 0}, {0, 0, 45}, {30, 40, 50}};
    voxels_world w;
    voxels_open(&w, *state);
    for (size_t i = 0; i < COUNT_OF(rotations); i++) {
        scene_mesh *thin = hollow_box(&w, (float)edge / 4, false, rotations[i]);
        scene_mesh *thick = hollow_box(&w, 1.2f * (float)edge, false, rotations[i]);
        assert_false(leaks(&w, thin, VOXELS_AUTO));
        assert_false(leaks(&w, thick, VOXELS_AUTO));
        assert_false(leaks(&w, hollow_box(&w, 0.5f, true, rotations[i]), VOXELS_SHELL));
        assert_true(leaks(&w, thin, VOXELS_SOLID)); // this test can fail
        if (i != 1) assert_true(leaks(&w, thick, VOXELS_SOLID) == (i == 2));
    }
    // Thick enough, a body is no larger for it.
    scene_mesh *thick = hollow_box(&w, 1.2f * (float)edge, false, rotations[0]);
    uint32_t *ids = voxelise(&w, &(voxels_body){thick, VOXELS_AUTO}, 1);
    assert_int_equal(count_ids(ids, 1), 16 * 16 * 16 - 14 * 14 * 14);
    mem_free(ids);
    voxels_close(&w);
}

static void sheet_is_one_cell_thick(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    for (int twice = 0; twice < 2; twice++) {
        shape s = {0};
        uint32_t at[4];
        for (int i = 0; i < 4; i++)
            at[i] = shape_vertex(&s, i & 1 ? 1 : -1, i & 2 ? 1 : -1, twice ? 0 : 0.03f);
        shape_triangle(&s, at[0], at[1], at[3]);
        shape_triangle(&s, at[0], at[3], at[2]);
        if (twice) { // its other side too, between two layers of cells
            shape_triangle(&s, at[0], at[3], at[1]);
            shape_triangle(&s, at[0], at[2], at[3]);
        }
        scene_mesh *mesh = shape_mesh(&w, &s);
        uint32_t *ids = voxelise(&w, &(voxels_body){mesh, VOXELS_AUTO}, 1);
        for (int i = 0; i < CELLS; i++) {
            int x = i % N, y = i / N % N, z = i / N / N;
            bool edge_cell = x == 7 || x == 24 || y == 7 || y == 24;
            bool want = z == 16 && x >= 8 && x < 24 && y >= 8 && y < 24;
            if ((ids[i] != 0) != want && !(edge_cell && z == 16))
                fail_msg("cell %d %d %d: %d", x, y, z, ids[i]);
        }
        mem_free(ids);
    }
    voxels_close(&w);
}

static void double_faces_and_inner_walls_count_as_what_they_are(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    for (int i = 0; i < 3; i++) {
        shape s = {0};
        if (i == 0) { // every face twice
            shape_box(&s, (float3){-0.95f, -0.95f, -0.95f}, (float3){0.95f, 0.95f, 0.95f});
            shape_box(&s, (float3){-0.95f, -0.95f, -0.95f}, (float3){0.95f, 0.95f, 0.95f});
        } else if (i == 1) { // and seen from both sides
            shape_box(&s, (float3){-0.95f, -0.95f, -0.95f}, (float3){0.95f, 0.95f, 0.95f});
            for (size_t k = 0; k < 36; k += 3)
                shape_triangle(&s, s.indices[k], s.indices[k + 2], s.indices[k + 1]);
        } else { // two boxes with a wall between them, which both have
            shape_box(&s, (float3){-0.95f, -0.95f, -0.95f}, (float3){0, 0.95f, 0.95f});
            shape_box(&s, (float3){0, -0.95f, -0.95f}, (float3){0.95f, 0.95f, 0.95f});
        }
        uint32_t *ids = voxelise(&w, &(voxels_body){shape_mesh(&w, &s), VOXELS_AUTO}, 1);
        if (count_ids(ids, 1) != 16 * 16 * 16) fail_msg("case %d: %zu", i, count_ids(ids, 1));
        mem_free(ids);
    }
    voxels_close(&w);
}

static void overlapping_parts_are_one_solid_and_cavities_are_not(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_box(&s, (float3){-1, -1, -1}, (float3){0.5f, 0.5f, 0.5f});
    shape_box(&s, (float3){0, 0, 0}, (float3){1, 1, 1});
    size_t inner = s.index_count;
    shape_box(&s, (float3){-0.75f, -0.75f, -0.75f}, (float3){-0.25f, -0.25f, -0.25f});
    for (size_t k = inner; k < s.index_count; k += 3) {
        uint32_t swap = s.indices[k];
        s.indices[k] = s.indices[k + 1];
        s.indices[k + 1] = swap;
    }
    uint32_t *ids = voxelise(&w, &(voxels_body){shape_mesh(&w, &s), VOXELS_SOLID}, 1);
    assert_int_equal(count_ids(ids, 1), 12 * 12 * 12 + 8 * 8 * 8 - 4 * 4 * 4 - 4 * 4 * 4);
    mem_free(ids);
    voxels_close(&w);
}

// ---- several bodies, and what moves -------------------------------------------------------------

static void later_body_has_the_cell(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_box(&s, (float3){-0.5f, -0.5f, -0.5f}, (float3){0.5f, 0.5f, 0.5f});
    scene_mesh *first = shape_mesh(&w, &s);
    scene_mesh second = *first, third = *first;
    second.position = triple(&w, 0.5f, 0, 0);
    third.position = triple(&w, -1.5f, 0, 0);
    const voxels_body bodies[] = {
        {first, VOXELS_AUTO}, {&second, VOXELS_AUTO}, {&third, VOXELS_AUTO}};
    uint32_t *ids = voxelise(&w, bodies, 3);
    assert_int_equal(count_ids(ids, 1), 4 * 8 * 8);
    assert_int_equal(count_ids(ids, 2), 8 * 8 * 8);
    assert_int_equal(count_ids(ids, 3), 8 * 8 * 8);
    mem_free(ids);
    voxels_close(&w);
}

static const field *moving(voxels_world *w, int components, const float *from, const float *to) {
    curve_key keys[2] = {{0, {0}}, {1, {0}}};
    memcpy(keys[0].value, from, (size_t)components * sizeof *from);
    memcpy(keys[1].value, to, (size_t)components * sizeof *to);
    const curve *c = curve_create(&w->memory, &(curve){CURVE_LINEAR, components, keys, 2, 0});
    gpu_test_ok(c);
    return field_curve(&w->memory, c);
}

static void moving_body_leaves_what_it_covered(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_box(&s, (float3){-1.5f, -0.5f, -0.5f}, (float3){1.5f, 0.5f, 0.5f});
    scene_mesh *still = shape_mesh(&w, &s);
    shape_sphere(&s, 6);
    scene_mesh *ball = shape_mesh(&w, &s);
    ball->position = moving(&w, 3, (float[]){-1, 0, 0}, (float[]){1, 0.3f, 0});
    ball->scale = moving(&w, 1, (float[]){0.4f}, (float[]){0.7f});
    const voxels_body bodies[] = {{still, VOXELS_AUTO}, {ball, VOXELS_AUTO}};
    voxels *v = make_voxels(&w, &(voxels_desc){around, {N, N, N}, bodies, 2, false});
    for (int i = 0; i <= 8; i++) {
        voxels_change change = update_voxels(&w, v, i / 8.0, 1 / 8.0);
        assert_true(change.cells && change.motion);
        uint32_t *ids = read_ids(&w, v), *want = voxelise(&w, bodies, 2);
        assert_memory_equal(ids, want, CELLS * sizeof *ids);
        mem_free(ids);
        mem_free(want);
    }
    // Each body when it moved, and no cell that neither left nor entered.
    voxels_work work = voxels_get_work(v);
    assert_int_equal(work.updates, 9);
    assert_int_equal(work.bodies, 10);
    assert_true(work.cells < CELLS + 8 * CELLS / 4);
    voxels_destroy(v, w.device);
    voxels_close(&w);
}

// A body for each eighth cell, as large as a cell; those of one row move on by a cell.
static void there_is_no_most_of_bodies(void **state) {
    enum { SIDE = N / 2, COUNT = SIDE * SIDE * SIDE };
    voxels_world w;
    voxels_open(&w, *state);
    const float cell = (around.max.x - around.min.x) / N, half = 0.45f * cell;
    shape s = {0};
    shape_box(&s, (float3){-half, -half, -half}, (float3){half, half, half});
    const scene_mesh *one = shape_mesh(&w, &s);
    scene_mesh *meshes = arena_alloc(&w.memory, COUNT * sizeof *meshes);
    voxels_body *bodies = arena_alloc(&w.memory, COUNT * sizeof *bodies);
    for (int i = 0; i < COUNT; i++) {
        float at[3] = {(float)(i % SIDE), (float)(i / SIDE % SIDE), (float)(i / SIDE / SIDE)};
        for (int k = 0; k < 3; k++) at[k] = around.min.x + cell * (2 * at[k] + 0.5f);
        const float to[3] = {at[0] + cell, at[1], at[2]};
        meshes[i] = *one;
        meshes[i].position = i < SIDE ? moving(&w, 3, at, to) : triple(&w, at[0], at[1], at[2]);
        bodies[i] = (voxels_body){&meshes[i], VOXELS_AUTO};
    }
    voxels *v = make_voxels(&w, &(voxels_desc){around, {N, N, N}, bodies, COUNT, false});
    for (int moved = 0; moved < 2; moved++) {
        update_voxels(&w, v, moved, 1);
        uint32_t *ids = read_ids(&w, v);
        assert_int_equal(count_ids(ids, 0), CELLS - COUNT);
        for (int i = 0; i < COUNT; i++) {
            int x = 2 * (i % SIDE) + (i < SIDE && moved), y = 2 * (i / SIDE % SIDE);
            int z = 2 * (i / SIDE / SIDE);
            assert_int_equal(ids[x + N * (y + N * z)], i + 1);
        }
        mem_free(ids);
    }
    assert_int_equal(voxels_get_work(v).bodies, COUNT + SIDE);
    voxels_destroy(v, w.device);
    voxels_close(&w);
}

static void what_stands_still_is_voxelised_once(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_sphere(&s, 6);
    const voxels_body body = {shape_mesh(&w, &s), VOXELS_AUTO};
    voxels *v = make_voxels(&w, &(voxels_desc){around, {N, N, N}, &body, 1, false});
    voxels_change first = update_voxels(&w, v, 0, 0);
    assert_true(first.cells && first.motion);
    for (int i = 1; i < 4; i++) {
        voxels_change change = update_voxels(&w, v, i, 1);
        assert_false(change.cells || change.motion);
    }
    assert_int_equal(voxels_get_work(v).updates, 1);
    voxels_destroy(v, w.device);
    voxels_close(&w);
}

static void expect_near(float3 got, float x, float y, float z) {
    if (!(fabsf(got.x - x) < 1e-3f && fabsf(got.y - y) < 1e-3f && fabsf(got.z - z) < 1e-3f))
        fail_msg("%g %g %g instead of %g %g %g", (double)got.x, (double)got.y, (double)got.z,
                 (double)x, (double)y, (double)z);
}

// A box beside its origin that turns about Z by a quarter of a turn a second, rises and grows.
static void motion_is_that_of_the_transforms(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_box(&s, (float3){0.5f, -0.25f, -0.25f}, (float3){1, 0.25f, 0.25f});
    scene_mesh *mesh = shape_mesh(&w, &s);
    mesh->rotation = moving(&w, 3, (float[]){0, 0, 0}, (float[]){0, 0, 90});
    mesh->position = moving(&w, 3, (float[]){0, 0, 0}, (float[]){0, 0, 0.5f});
    mesh->scale = moving(&w, 1, (float[]){1}, (float[]){1.5f});
    voxels_body body = {mesh, VOXELS_AUTO};
    voxels *v = make_voxels(&w, &(voxels_desc){around, {N, N, N}, &body, 1, false});
    const double dt = 1.0 / 256;
    voxels_motion m;
    update_voxels(&w, v, 0.5, dt);
    voxels_get_motion(v, 0, &m);
    expect_near(m.linear, 0, 0, 0); // it was put there
    assert_true(update_voxels(&w, v, 0.5 + dt, dt).motion);
    voxels_get_motion(v, 0, &m);
    float turn = 1.5707963f, grown = 1.25f + 0.5f / 256, angle = turn * (0.5f + 1.0f / 256);
    float x = 0.75f * grown * cosf(angle), y = 0.75f * grown * sinf(angle);
    expect_near(m.centre, x, y, 0.25f + 0.5f / 256);
    expect_near(m.angular, 0, 0, turn);
    assert_true(fabsf(m.growth - 0.5f / grown) < 1e-3f);
    float ahead = turn / 2 * (float)dt; // of a difference backwards
    assert_true(fabsf(m.linear.x - (-turn * y + 0.5f / grown * x)) < 5 * ahead);
    assert_true(fabsf(m.linear.y - (turn * x + 0.5f / grown * y)) < 5 * ahead);
    assert_true(fabsf(m.linear.z - 0.5f) < 1e-3f);
    update_voxels(&w, v, 2, 1);
    voxels_change change = update_voxels(&w, v, 3, 1); // the curves have ended
    voxels_get_motion(v, 0, &m);
    expect_near(m.linear, 0, 0, 0);
    assert_true(change.motion && !change.cells);
    voxels_destroy(v, w.device);
    voxels_close(&w);
}

// A function of the script, which fails when it is told to.
static bool call(void *user, int function, double time, float out[4]) {
    (void)function;
    out[0] = (float)time;
    return !*(bool *)user || err_set("no");
}

static void update_that_fails_is_made_up_for(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    bool fails = false;
    w.context.call = call;
    w.context.user = &fails;
    shape s = {0};
    shape_sphere(&s, 6);
    scene_mesh *first = shape_mesh(&w, &s), second = *first;
    first->position = moving(&w, 3, (float[]){-1, 0, 0}, (float[]){1, 0, 0});
    second.position = triple(&w, 0, 0.5f, 1);
    second.scale = field_call(&w.memory, 1, 0);
    const voxels_body bodies[] = {{first, VOXELS_AUTO}, {&second, VOXELS_AUTO}};
    voxels *v = make_voxels(&w, &(voxels_desc){around, {N, N, N}, bodies, 2, false});
    update_voxels(&w, v, 0.25, 0);
    voxels_change change;
    fails = true;
    w.context.time = 0.5;
    gpu_test_ok(gpu_frame_begin(*state));
    assert_false(voxels_update(v, *state, &w.context, 0.25, &change));
    gpu_test_ok(gpu_frame_end(*state));
    fails = false;
    assert_true(update_voxels(&w, v, 0.5, 0.25).cells);
    uint32_t *ids = read_ids(&w, v), *want = voxelise(&w, bodies, 2);
    assert_memory_equal(ids, want, CELLS * sizeof *ids);
    mem_free(ids);
    mem_free(want);
    voxels_destroy(v, *state);
    voxels_close(&w);
}

static void what_cannot_be_voxelised_is_refused(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_sphere(&s, 4);
    scene_mesh *mesh = shape_mesh(&w, &s);
    const box3 flat = {{0, 0, 0}, {1, 1, 0}};
    assert_null(voxels_create(&w.memory, &(voxels_desc){around, {30, 32, 32}, NULL, 0, false}));
    assert_non_null(strstr(err_get(), "multiple of 4"));
    assert_null(voxels_create(&w.memory, &(voxels_desc){around, {32, 0, 32}, NULL, 0, false}));
    assert_null(voxels_create(&w.memory, &(voxels_desc){flat, {32, 32, 32}, NULL, 0, false}));
    uint32_t *ids = voxelise(&w, NULL, 0);
    assert_int_equal(count_ids(ids, 0), CELLS);
    mem_free(ids);
    mesh->scale = number(&w, 0);
    ids = voxelise(&w, &(voxels_body){mesh, VOXELS_AUTO}, 1);
    assert_int_equal(count_ids(ids, 0), CELLS);
    mem_free(ids);
    voxels_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_hold_the_centres_that_they_hold),
        cmocka_unit_test(centres_on_faces_edges_and_corners_count_once),
        cmocka_unit_test(hole_leaves_no_streak),
        cmocka_unit_test(thin_walls_and_shells_let_nothing_through),
        cmocka_unit_test(sheet_is_one_cell_thick),
        cmocka_unit_test(double_faces_and_inner_walls_count_as_what_they_are),
        cmocka_unit_test(overlapping_parts_are_one_solid_and_cavities_are_not),
        cmocka_unit_test(later_body_has_the_cell),
        cmocka_unit_test(moving_body_leaves_what_it_covered),
        cmocka_unit_test(there_is_no_most_of_bodies),
        cmocka_unit_test(what_stands_still_is_voxelised_once),
        cmocka_unit_test(motion_is_that_of_the_transforms),
        cmocka_unit_test(update_that_fails_is_made_up_for),
        cmocka_unit_test(what_cannot_be_voxelised_is_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
