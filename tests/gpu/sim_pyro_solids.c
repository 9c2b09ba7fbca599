// Solids in burning gas: nothing passes them, what comes in goes around them, and what moves
// pushes.
#include "pyro_test.h"
#include "shared.h"

typedef struct block { // cells from low up to, not with, high are solid
    int low[3], high[3];
} block;

static bool is_in(const block *b, const int c[3]) {
    for (int i = 0; i < 3; i++)
        if (c[i] < b->low[i] || c[i] >= b->high[i]) return false;
    return true;
}

typedef struct solid_world {
    pyro_world w;
    gpu_buffer *ids, *motions;
} solid_world;

static void open_world(solid_world *s, gpu *g, const pyro_desc *desc, const block *b,
                       const float velocity[3]) {
    pyro_desc d = *desc;
    d.solids = true;
    pyro_open(&s->w, g, &d);
    uint32_t *ids = mem_alloc(s->w.cells * sizeof *ids);
    struct voxel_motion motions[2];
    memset(motions, 0, sizeof motions);
    memcpy(&motions[1].linear, velocity, 3 * sizeof *velocity);
    size_t i = 0;
    int c[3];
    for (c[2] = 0; c[2] < (int)d.size[2]; c[2]++)
        for (c[1] = 0; c[1] < (int)d.size[1]; c[1]++)
            for (c[0] = 0; c[0] < (int)d.size[0]; c[0]++) ids[i++] = is_in(b, c);
    s->ids = gpu_buffer_create(g, &(gpu_buffer_desc){.size = s->w.cells * sizeof *ids});
    s->motions = gpu_buffer_create(g, &(gpu_buffer_desc){.size = sizeof motions});
    gpu_test_ok(gpu_buffer_write(g, s->ids, 0, ids, s->w.cells * sizeof *ids));
    gpu_test_ok(gpu_buffer_write(g, s->motions, 0, motions, sizeof motions));
    mem_free(ids);
}

static void run(solid_world *s, int steps) {
    for (int i = 0; i < steps; i++) {
        gpu_test_ok(gpu_frame_begin(s->w.device));
        pyro_set_solids(s->w.solver, &(pyro_solids){.ids = s->ids, .motions = s->motions});
        gpu_test_ok(pyro_step(s->w.solver, s->w.device, &s->w.numbers, false));
        gpu_test_ok(gpu_frame_end(s->w.device));
    }
    pyro_transfer(&s->w, false);
}

static void close_world(solid_world *s) {
    gpu_test_ok(gpu_idle(s->w.device));
    gpu_buffer_destroy(s->w.device, s->ids);
    gpu_buffer_destroy(s->w.device, s->motions);
    pyro_close(&s->w);
}

// What passes a plane across x through the duct, cells^2 m/s.
static double flux(pyro_world *w, int x) {
    double sum = 0;
    int c[3] = {x, 0, 0};
    for (c[2] = 0; c[2] < (int)w->desc.size[2]; c[2]++)
        for (c[1] = 0; c[1] < (int)w->desc.size[1]; c[1]++) sum += (double)*pyro_face_at(w, 0, c);
    return sum;
}

static const pyro_desc duct = {
    .size = {64, 32, 32},
    .faces = {PYRO_INFLOW, PYRO_OPEN, PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL},
    .advection = PYRO_PARABOLIC,
};

// A plate that leaves a slit: all that comes in goes through it.
static void check_slit(gpu *g, pyro_advection advection) {
    solid_world s;
    const block plate = {{30, 0, 0}, {32, 32, 24}};
    pyro_desc desc = duct;
    desc.advection = advection;
    open_world(&s, g, &desc, &plate, (float[3]){0, 0, 0});
    s.w.numbers.inflow[0] = 1;
    s.w.numbers.gravity = 0;
    gpu_test_ok(gpu_frame_begin(s.w.device));
    gpu_test_ok(pyro_reset(s.w.solver, s.w.device, &s.w.numbers));
    gpu_test_ok(gpu_frame_end(s.w.device));
    run(&s, 12);
    double through = 0, most = 0;
    int c[3];
    for (c[0] = 30; c[0] <= 32; c[0]++) // both sides of the plate, and its middle
        for (c[2] = 0; c[2] < 32; c[2]++)
            for (c[1] = 0; c[1] < 32; c[1]++) {
                const double u = (double)*pyro_face_at(&s.w, 0, c);
                if (c[2] < 24) through = fmax(through, fabs(u));
                most = fmax(most, u);
            }
    const double slit = flux(&s.w, 31) / 1024, behind = flux(&s.w, 60) / 1024;
    print_message(
        "in 1, through the slit %.4f, behind %.4f; fastest %.2f m/s, through the plate %g\n", slit,
        behind, most, through);
    assert_true(fabs(slit - 1) < 2e-3 && fabs(behind - 1) < 2e-3);
    assert_true(through == 0 && most > 3.5 && most < 6);
    close_world(&s);
}

static void what_comes_in_goes_around(void **state) {
    for (pyro_advection a = PYRO_PARABOLIC; a <= PYRO_REFLECTION; a++) check_slit(*state, a);
}

// A piston that fills the duct pushes as much as it sweeps. Coarse levels see past it: cycles alone
// leave 27 % of that wrong after these steps.
static void what_moves_pushes(void **state) {
    solid_world s;
    pyro_desc tube = duct;
    tube.faces[0] = PYRO_OPEN;
    const block piston = {{20, 0, 0}, {24, 32, 32}};
    open_world(&s, *state, &tube, &piston, (float[3]){0.5f, 0, 0});
    s.w.numbers.gravity = 0;
    run(&s, 4);
    const double before = flux(&s.w, 8) / 1024, behind = flux(&s.w, 50) / 1024;
    print_message("a piston at 0.5 m/s moves %.4f before and %.4f behind it\n", behind, before);
    assert_true(fabs(before - 0.5) < 2e-3 && fabs(behind - 0.5) < 2e-3);
    close_world(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_comes_in_goes_around),
        cmocka_unit_test(what_moves_pushes),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
