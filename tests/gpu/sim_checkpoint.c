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

// ---- layouts ----------------------------------------------------------------------------------

typedef struct saved { // a state in memory, as another program may have left it
    sim_world w;
    checkpoint_list parts;
} saved;

static void save_at_rest(saved *s, gpu *device, uint32_t lanes, lbm_order order) {
    *s = (saved){0};
    sim_open(&s->w, device,
             &(lbm_desc){.size = {16, 8, 16},
                         .precision = LBM_F16,
                         .scalars = 1,
                         .lanes = lanes,
                         .order = order});
    sim_reset(&s->w);
    lbm_state_list(s->w.lattice, "air", "", &s->parts);
}

static void close_saved(saved *s) {
    checkpoint_list_free(&s->parts);
    sim_close(&s->w);
}

static bool takes(sim_world *w, const checkpoint_list *parts) {
    checkpoint *c = checkpoint_keep(w->device, parts->parts, parts->count);
    gpu_test_ok(c);
    bool done = lbm_state_load(w->lattice, w->device, "air", "", c);
    checkpoint_close(c);
    return done;
}

static void expect_message(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("'%s' does not say '%s'", err_get(), part);
}

// Sizes alone would let each pass for the others.
static void states_that_lie_otherwise_are_refused(void **state) {
    static const struct {
        uint32_t lanes;
        lbm_order order;
    } ways[] = {{4, LBM_WHOLE}, {4, LBM_BLOCKS}, {2, LBM_WHOLE}, {2, LBM_BLOCKS}};
    saved all[COUNT_OF(ways)];
    for (size_t i = 0; i < COUNT_OF(ways); i++)
        save_at_rest(&all[i], *state, ways[i].lanes, ways[i].order);
    for (size_t i = 0; i < COUNT_OF(ways); i++)
        for (size_t k = 0; k < COUNT_OF(ways); k++) {
            assert_int_equal(all[i].parts.count, all[k].parts.count);
            for (size_t part = 1; part < all[i].parts.count; part++) // but for the text
                assert_int_equal(all[i].parts.parts[part].size, all[k].parts.parts[part].size);
            assert_int_equal(takes(&all[i].w, &all[k].parts), i == k);
            if (i != k) expect_message("the checkpoint was made with layout = ");
        }
    for (size_t i = 0; i < COUNT_OF(ways); i++) close_saved(&all[i]);
}

// Puts `by` in the place of `what` and all behind it in the line.
static void edit_text(saved *s, const char *what, const char *by) {
    checkpoint_part *text = &s->parts.parts[0];
    assert_string_equal(text->name, "air/lattice");
    char *begin = strstr(text->bytes, what);
    assert_non_null(begin);
    const char *end = begin + strcspn(begin, "\n");
    text->bytes = arena_format(&s->parts.memory, "%.*s%s%s", (int)(begin - (char *)text->bytes),
                               (char *)text->bytes, by, end);
    text->size = strlen(text->bytes);
}

static void a_state_of_another_version_is_refused(void **state) {
    static const struct {
        const char *what, *by, *said;
    } cases[] = {
        {"layout = ", "order = 2 cells, blocks of bundles", // before layouts were told in full
         "made with order = 2 cells, blocks of bundles, the effect has layout = "},
        {"layout = ", "layout = 1", "made with layout = 1, the effect has layout = "},
        {"bundles of ", "bundles of 1, blocks of 128", "bundles of 1, blocks of 128, the effect"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        saved s;
        save_at_rest(&s, *state, 2, LBM_BLOCKS);
        assert_true(takes(&s.w, &s.parts));
        edit_text(&s, cases[i].what, cases[i].by);
        assert_false(takes(&s.w, &s.parts));
        expect_message(cases[i].said);
        close_saved(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_restored_state_goes_on_bit_by_bit),
        cmocka_unit_test(what_is_kept_in_memory_stays_as_it_was),
        cmocka_unit_test(states_that_lie_otherwise_are_refused),
        cmocka_unit_test(a_state_of_another_version_is_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
