// Meshes as cells, held against an exact inside test.
#include "voxels_test.h"

static const box3 around = {{-2, -2, -2}, {2, 2, 2}};
enum { N = 32, CELLS = N * N * N };
static const double edge = 4.0 / N;

static double3 centre_of(int x, int y, int z) {
    return (double3){{-2 + edge * (x + 0.5), -2 + edge * (y + 0.5), -2 + edge * (z + 0.5)}};
}

static uint8_t *voxelise(voxels_world *w, const voxels_body *bodies, size_t count) {
    voxels *v = make_voxels(w, &(voxels_desc){around, {N, N, N}, bodies, count});
    update_voxels(w, v, 0, 0);
    uint8_t *ids = read_ids(w, v);
    voxels_destroy(v, w->device);
    return ids;
}

static size_t count_ids(const uint8_t *ids, uint8_t id) {
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
static void expect_exact(voxels_world *w, const scene_mesh *mesh, const uint8_t *ids,
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
        uint8_t *ids = voxelise(&w, &(voxels_body){mesh, 7, rule}, 1);
        assert_true(count_ids(ids, 7) + count_ids(ids, 0) == CELLS);
        char what[16];
        snprintf(what, sizeof what, "shape %d", i);
        expect_exact(&w, mesh, ids, what);
        mem_free(ids);
    }
    voxels_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_hold_the_centres_that_they_hold),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
