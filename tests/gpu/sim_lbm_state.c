// The state of a solver: what it conserves, what is kept of it for others.
#include "long_test.h"
#include "sim_test.h"

// ---- what stays -------------------------------------------------------------------------------

typedef struct total {
    double mass, momentum[3], scalar;
} total;

static total add_up(sim_world *w) {
    total t = {0};
    sim_read(w);
    for (size_t i = 0; i < w->cells; i++) {
        t.mass += w->state[i].density / (double)w->cells;
        t.scalar += w->state[i].scalar[0] / (double)w->cells;
        for (int k = 0; k < 3; k++)
            t.momentum[k] += w->state[i].density * w->state[i].u[k] / (double)w->cells;
    }
    return t;
}

typedef struct drift {
    double mass, momentum, scalar;
} drift;

// Of ten thousand steps. Between walls what they throw back lies in their cells, and counts.
static drift drift_of(gpu *g, lbm_precision precision, lbm_face face) {
    sim_world w;
    sim_open(&w, g,
             &(lbm_desc){.size = {16, 16, 16},
                         .collision = LBM_CENTRAL_MOMENTS,
                         .precision = precision,
                         .faces = {face, face, face, face, face, face},
                         .scalars = 1});
    w.numbers.tau = 0.501f;
    sim_set_state(&w, swirl);
    total before = add_up(&w);
    sim_run(&w, 10000);
    total after = add_up(&w);
    drift d = {.mass = after.mass / before.mass - 1, .scalar = after.scalar / before.scalar - 1};
    for (int k = 0; k < 3; k++)
        d.momentum = fmax(d.momentum, fabs(after.momentum[k] - before.momentum[k]) / swirl_speed);
    print_message("10000 steps, %s, %s: mass %.1e, scalar %.1e, momentum %.1e off\n",
                  precision ? "FP16" : "FP32", face ? "closed" : "periodic", d.mass, d.scalar,
                  d.momentum);
    sim_close(&w);
    return d;
}

static void mass_and_momentum_stay_for_ten_thousand_steps(void **state) {
    drift d = drift_of(*state, LBM_F16, LBM_PERIODIC);
    assert_true(fabs(d.mass) < 1e-4 && fabs(d.scalar) < 1e-2 && d.momentum < 2.4e-4);
    if (!sim_long_tests("ten thousand steps in single precision, and between walls")) return;
    d = drift_of(*state, LBM_F32, LBM_PERIODIC);
    assert_true(fabs(d.mass) < 1e-8 && fabs(d.scalar) < 2e-7 && d.momentum < 1e-6);
    d = drift_of(*state, LBM_F32, LBM_WALL);
    assert_true(fabs(d.mass) < 1e-8 && fabs(d.scalar) < 2e-7);
    d = drift_of(*state, LBM_F16, LBM_WALL);
    assert_true(fabs(d.mass) < 2e-5 && fabs(d.scalar) < 6e-3);
}

// ---- a blast ----------------------------------------------------------------------------------

enum { BLAST = 40, NEAR = 16 }; // cells; those nearer than NEAR have not heard of the blast beyond

static void blast(int x, int y, int z, sim_cell *cell) {
    double r2 = pow(x - BLAST / 2, 2) + pow(y - BLAST / 2, 2) + pow(z - BLAST / 2, 2);
    cell->density = 1 + 0.05 * exp(-r2 / 12);
}

// Of cells equally far from the centre, how much their densities differ: relative to the greatest
// change there is.
static double roughness(const sim_world *w) {
    static double least[NEAR * NEAR], most[NEAR * NEAR];
    double spread = 0, change = 0;
    for (int i = 0; i < NEAR * NEAR; i++) least[i] = 1e9, most[i] = -1e9;
    for (size_t c = 0; c < w->cells; c++) {
        int x = (int)(c % BLAST) - BLAST / 2, y = (int)(c / BLAST % BLAST) - BLAST / 2;
        int z = (int)(c / BLAST / BLAST) - BLAST / 2, r2 = x * x + y * y + z * z;
        double d = w->state[c].density - 1;
        if (r2 >= NEAR * NEAR) continue;
        least[r2] = fmin(least[r2], d);
        most[r2] = fmax(most[r2], d);
        change = fmax(change, fabs(d));
    }
    for (int i = 0; i < NEAR * NEAR; i++)
        if (most[i] >= least[i]) spread = fmax(spread, most[i] - least[i]);
    return spread / change;
}

static void a_blast_is_round(void **state) {
    for (int set = 0; set < 2; set++) {
        sim_world w;
        sim_open(&w, *state,
                 &(lbm_desc){.size = {BLAST, BLAST, BLAST},
                             .set = (lbm_set)set,
                             .collision = LBM_CENTRAL_MOMENTS});
        w.numbers.tau = 0.51f;
        sim_set_state(&w, blast);
        sim_run(&w, 18); // sound comes 10.4 cells far
        sim_read(&w);
        double error = roughness(&w);
        print_message("blast, %s: densities equally far away differ by %.2f %%\n",
                      set ? "D3Q27" : "D3Q19", 100 * error);
        assert_true(error < 0.03);
        sim_close(&w);
    }
}

// ---- large states, and what others see ---------------------------------------------------------

typedef struct moments { // as kept, of a cell
    float u[3], excess, scalar[3], body;
} moments;

static moments look(sim_world *w, int which, size_t cell) {
    uint16_t halves[8];
    float v[8];
    gpu_test_ok(lbm_moments(w->lattice, which));
    gpu_test_ok(gpu_buffer_read(w->device, lbm_moments(w->lattice, which), 16 * cell, halves, 16));
    for (int i = 0; i < 8; i++) v[i] = half_to_float(halves[i]);
    return (moments){{v[0], v[1], v[2]}, v[3], {v[4], v[5], v[6]}, v[7]};
}

static void step_kept(sim_world *w) {
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(lbm_step(w->lattice, w->device, &w->numbers, true));
    gpu_test_ok(gpu_frame_end(w->device));
    gpu_test_ok(gpu_idle(w->device));
}

// D3Q27 at 128 x 128 x 80 in 32 bits: more than lavapipe can bind at once.
static void a_state_in_several_buffers_works(void **state) {
    sim_world w;
    sim_open(&w, *state, &(lbm_desc){.size = {128, 128, 80}, .set = LBM_D3Q27, .scalars = 1});
    w.numbers.acceleration[0] = 1e-3f;
    w.numbers.ambient[0] = 0.5f;
    w.numbers.buoyancy[0][2] = 1;
    sim_reset(&w);
    sim_run(&w, 3);
    step_kept(&w);
    for (size_t i = 0; i < 5; i++) { // three steps and a half
        moments m = look(&w, 0, i * (w.cells - 1) / 4);
        assert_true(fabsf(m.u[0] - 3.5e-3f) < 4e-6f && fabsf(m.u[2]) < 1e-6f);
        assert_true(fabsf(m.excess) < 1e-5f && fabsf(m.scalar[0] - 0.5f) < 1e-3f);
    }
    sim_close(&w);
}

static void what_is_kept_is_the_state_before_the_step(void **state) {
    for (int precision = 0; precision < 2; precision++) {
        sim_world w;
        sim_open(
            &w, *state,
            &(lbm_desc){.size = {16, 16, 16}, .precision = (lbm_precision)precision, .scalars = 2});
        sim_set_state(&w, swirl);
        assert_null(lbm_moments(w.lattice, 0));
        step_kept(&w);
        assert_null(lbm_moments(w.lattice, 1));
        step_kept(&w);
        for (int z = 0; z < 16; z += 5) {
            sim_cell expected = {.density = 1};
            swirl(3, 7, z, &expected);
            moments m = look(&w, 1, sim_index(&w, 3, 7, z));
            for (int k = 0; k < 3; k++) assert_true(fabs((double)m.u[k] - expected.u[k]) < 1e-4);
            assert_true(fabs((double)m.excess - (expected.density - 1)) < 1e-4);
            assert_true(fabs((double)m.scalar[0] - expected.scalar[0]) < 2e-3);
            assert_true(m.scalar[1] == 0 && m.scalar[2] == 0 && m.body == 0);
        }
        sim_close(&w);
    }
}

static void stream(int x, int y, int z, sim_cell *out) {
    (void)x, (void)y, (void)z;
    out->u[0] = 0.05;
    out->scalar[1] = 0.5;
}

static void a_force_comes_from_an_image(void **state) {
    sim_world w;
    sim_open(&w, *state,
             &(lbm_desc){.size = {16, 16, 16}, .collision = LBM_CENTRAL_MOMENTS, .force = true});
    gpu_image *image = gpu_image_create(w.device, &(gpu_image_desc){.label = "force",
                                                                    .format = GPU_RGBA32F,
                                                                    .width = 1,
                                                                    .height = 1,
                                                                    .depth = 2,
                                                                    .use = GPU_USE_SAMPLED});
    const float below_and_above[8] = {0, 2, 0, 0, 0, -2, 0, 0};
    gpu_test_ok(gpu_image_write(w.device, image, 0, below_and_above, sizeof below_and_above));
    lbm_set_force(w.lattice, image, 1e-3f, 0);
    sim_reset(&w);
    step_kept(&w);
    assert_true(fabsf(look(&w, 0, sim_index(&w, 5, 5, 1)).u[1] - 1e-3f) < 2e-6f);
    assert_true(fabsf(look(&w, 0, sim_index(&w, 5, 5, 14)).u[1] + 1e-3f) < 2e-6f);
    gpu_image_destroy(w.device, image);
    sim_close(&w);
}

// As fast as it is, and with what it carries, in all ways in which scalars are carried.
static void air_comes_from_an_image_and_goes(void **state) {
    static const lbm_desc descs[] = {
        {.collision = LBM_CENTRAL_MOMENTS},
        {.collision = LBM_TRT, .set = LBM_D3Q27, .scalar_set = LBM_SCALAR_D3Q27},
        {.scalar_set = LBM_SCALAR_D3Q27, .precision = LBM_F16, .lanes = 2}, // scalars go alone
    };
    for (size_t k = 0; k < 2 * COUNT_OF(descs); k++) {
        const double each = k % 2 ? -2e-3 : 2e-3;
        lbm_desc desc = descs[k / 2];
        desc.size[0] = desc.size[1] = desc.size[2] = 16;
        desc.force = desc.outflow = true, desc.scalars = 2;
        sim_world w;
        sim_open(&w, *state, &desc);
        gpu_image *image = gpu_image_create(w.device, &(gpu_image_desc){.label = "outflow",
                                                                        .format = GPU_RGBA32F,
                                                                        .width = 1,
                                                                        .height = 1,
                                                                        .depth = 1,
                                                                        .use = GPU_USE_SAMPLED});
        gpu_test_ok(gpu_image_write(w.device, image, 0, (float[4]){0, 0, 0, (float)each * 10}, 16));
        lbm_set_force(w.lattice, image, 1, 0.1f);
        sim_set_state(&w, stream);
        for (int i = 0; i < 20; i++) step_kept(&w);
        const moments m = look(&w, 0, sim_index(&w, 3, 9, 14)); // before the last step
        const double grown = pow(1 + each, 19);
        print_message("density %.5f, scalar %.5f, speed %.5f; theory %.5f, %.5f, 0.05\n",
                      1 + (double)m.excess, (double)m.scalar[1], (double)m.u[0], grown,
                      0.5 * grown);
        const double slack = desc.precision == LBM_F16 ? 1e-3 : 1e-4;
        assert_true(fabs((double)m.excess - (grown - 1)) < slack * 0.5);
        assert_true(fabs((double)m.scalar[1] - 0.5 * grown) < slack + 3e-4); // of a half
        assert_true(fabs((double)m.u[0] - 0.05) < slack * 0.5);
        gpu_image_destroy(w.device, image);
        sim_close(&w);
    }
}

static void speeds_are_kept_below_what_is_asked(void **state) {
    sim_world w;
    sim_open(&w, *state, &(lbm_desc){.size = {16, 16, 16}, .collision = LBM_CENTRAL_MOMENTS});
    w.numbers.max_speed = 0.04f;
    sim_set_state(&w, swirl);
    step_kept(&w);
    for (size_t i = 0; i < w.cells; i += 97) {
        moments m = look(&w, 0, i);
        assert_true(sqrtf(m.u[0] * m.u[0] + m.u[1] * m.u[1] + m.u[2] * m.u[2]) < 0.0401f);
    }
    sim_close(&w);
}

static void solvers_of_one_structure_exchange_their_states(void **state) {
    sim_world a, b;
    const lbm_desc desc = {.size = {16, 16, 16}};
    sim_open(&a, *state, &desc);
    sim_open(&b, *state, &desc);
    sim_set_state(&a, swirl);
    sim_reset(&b);
    sim_run(&a, 3);
    assert_true(lbm_exchange(a.lattice, b.lattice));
    assert_int_equal(lbm_steps(a.lattice), 0);
    assert_int_equal(lbm_steps(b.lattice), 3);
    sim_read(&a);
    assert_true(a.state[77].u[0] == 0 && a.state[77].density == 1);
    sim_read(&b);
    assert_true(b.state[77].u[0] != 0);
    sim_close(&b);
    sim_open(&b, *state, &(lbm_desc){.size = {16, 16, 32}});
    assert_false(lbm_exchange(a.lattice, b.lattice));
    sim_close(&b);
    sim_close(&a);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(mass_and_momentum_stay_for_ten_thousand_steps),
        cmocka_unit_test(a_blast_is_round),
        cmocka_unit_test(a_state_in_several_buffers_works),
        cmocka_unit_test(what_is_kept_is_the_state_before_the_step),
        cmocka_unit_test(a_force_comes_from_an_image),
        cmocka_unit_test(air_comes_from_an_image_and_goes),
        cmocka_unit_test(speeds_are_kept_below_what_is_asked),
        cmocka_unit_test(solvers_of_one_structure_exchange_their_states),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
