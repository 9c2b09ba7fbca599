// A solver that goes on from a checkpoint is the one that never stopped, bit by bit: populations of
// either parity, moments, cells that a body leaves and enters, waves at open faces.
#include "base/file.h"
#include "sim/lbm_state.h"
#include "sim_bodies_test.h"
#include <unistd.h>

enum { BEFORE = 21, AFTER = 18 }; // odd: the directions of pairs have changed places

static const lbm_desc structure = {
    .size = {24, 16, 32},
    .set = LBM_D3Q19,
    .precision = LBM_F16,
    .faces = {LBM_INFLOW, LBM_OPEN, LBM_SLIP, LBM_WALL, LBM_OPEN, LBM_OPEN},
    .scalars = 1,
    .bodies = true,
};

typedef struct run {
    sim_world w;
    sim_bodies bodies;
} run;

static void run_open(run *r, gpu *device) {
    sim_open(&r->w, device, &structure);
    sim_bodies_open(&r->w, &r->bodies);
    r->w.numbers.inflow[0][0] = 0.05f;
    r->w.numbers.inflow_scalar[0][0] = 1;
    r->w.numbers.buoyancy[0][2] = 1e-3f;
    r->bodies.body[0] = (lbm_body){.centre = {0, 8, 12}, .linear = {0.2f, 0, 0}};
}

static void run_close(run *r) {
    sim_bodies_close(&r->w, &r->bodies);
    sim_close(&r->w);
}

static int ball(const float p[3], const void *user) {
    float x = p[0] - *(const float *)user, y = p[1] - 8, z = p[2] - 12;
    return x * x + y * y + z * z < 20;
}

static void steps(run *r, uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        float at = 6 + 0.2f * (float)lbm_steps(r->w.lattice);
        r->bodies.body[0].centre[0] = at;
        gpu_test_ok(gpu_frame_begin(r->w.device));
        sim_bodies_set(&r->w, &r->bodies, ball, &at);
        gpu_test_ok(lbm_step(r->w.lattice, r->w.device, &r->w.numbers, i % 3 != 1));
        gpu_test_ok(gpu_frame_end(r->w.device));
    }
}

static void save(run *r, const char *path) {
    checkpoint_list list = {0};
    lbm_state_list(r->w.lattice, "air", "voxel_size = 0.05\n", &list);
    gpu_test_ok(checkpoint_save(path, r->w.device, list.parts, list.count));
    checkpoint_list_free(&list);
}

static void load(run *r, const char *path) {
    checkpoint *c = checkpoint_open(path);
    gpu_test_ok(c);
    gpu_test_ok(lbm_state_load(r->w.lattice, r->w.device, "air", "voxel_size = 0.05\n", c));
    checkpoint_close(c);
}

static void assert_same_file(const char *a, const char *b) {
    void *data[2];
    size_t size[2];
    gpu_test_ok(file_read(a, 1 << 28, &data[0], &size[0]));
    gpu_test_ok(file_read(b, 1 << 28, &data[1], &size[1]));
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    mem_free(data[0]);
    mem_free(data[1]);
}

static void a_restored_state_goes_on_bit_by_bit(void **state) {
    run through, again;
    char folder[] = "/tmp/roil-sim-XXXXXX", middle[64], ends[2][64];
    assert_non_null(mkdtemp(folder));
    snprintf(middle, sizeof middle, "%s/middle", folder);
    for (int i = 0; i < 2; i++) snprintf(ends[i], sizeof ends[i], "%s/end%d", folder, i);
    run_open(&through, *state);
    run_open(&again, *state);
    sim_reset(&through.w);
    steps(&through, BEFORE);
    save(&through, middle);
    steps(&through, AFTER);
    save(&through, ends[0]);
    load(&again, middle);
    assert_int_equal(lbm_steps(again.w.lattice), BEFORE);
    steps(&again, AFTER);
    save(&again, ends[1]);
    assert_same_file(ends[0], ends[1]); // every part of a state is in it
    run_close(&through);
    run_close(&again);
    unlink(middle);
    for (int i = 0; i < 2; i++) unlink(ends[i]);
    rmdir(folder);
}

// The same without a file: kept twice, gone on from twice.
static void what_is_kept_in_memory_stays_as_it_was(void **state) {
    run r;
    char folder[] = "/tmp/roil-sim-XXXXXX", ends[2][64];
    assert_non_null(mkdtemp(folder));
    run_open(&r, *state);
    sim_reset(&r.w);
    steps(&r, BEFORE);
    checkpoint_list list = {0};
    lbm_state_list(r.w.lattice, "air", "voxel_size = 0.05\n", &list);
    checkpoint *kept = checkpoint_keep(r.w.device, list.parts, list.count);
    gpu_test_ok(kept);
    checkpoint_list_free(&list);
    for (int i = 0; i < 2; i++) {
        snprintf(ends[i], sizeof ends[i], "%s/end%d", folder, i);
        if (i)
            gpu_test_ok(
                lbm_state_load(r.w.lattice, r.w.device, "air", "voxel_size = 0.05\n", kept));
        assert_int_equal(lbm_steps(r.w.lattice), BEFORE);
        steps(&r, AFTER);
        save(&r, ends[i]);
    }
    assert_same_file(ends[0], ends[1]);
    assert_false(lbm_state_load(r.w.lattice, r.w.device, "air", "voxel_size = 0.1\n", kept));
    checkpoint_close(kept);
    run_close(&r);
    for (int i = 0; i < 2; i++) unlink(ends[i]);
    rmdir(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_restored_state_goes_on_bit_by_bit),
        cmocka_unit_test(what_is_kept_in_memory_stays_as_it_was),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
