// The vortex of Taylor and Green: how much of its energy each way of carrying keeps, beside what is
// known of a Reynolds number of 1600.
#include "theory.h"

static const double pi = 3.14159265358979;

// An eighth of the vortex, which its planes of symmetry bound: a box of side pi within walls that
// air slips along.
static void swirl(pyro_world *w, const int c[3], void *data) {
    (void)data;
    const double k = pi / w->desc.size[0];
    const double z = cos(k * (c[2] + 0.5));
    *pyro_face_at(w, 0, c) = (float)(sin(k * c[0]) * cos(k * (c[1] + 0.5)) * z);
    *pyro_face_at(w, 1, c) = (float)(-cos(k * (c[0] + 0.5)) * sin(k * c[1]) * z);
}

// By that of the beginning.
static double energy(pyro_world *w) {
    double sum = 0;
    pyro_transfer(w, false);
    for (size_t i = 0; i < w->cells; i++)
        for (int k = 0; k < 3; k++) sum += (double)w->velocity[i][k] * (double)w->velocity[i][k];
    return sum;
}

enum { LAST = 12, LOOKS = 4 * LAST }; // times, and looks

typedef struct history {
    double energy[LOOKS + 1]; // by unit of volume and of speed squared
    double peak, peak_at;
} history;

static history run(const theory_order *order, theory_check *c, pyro_advection advection,
                   uint32_t cells) {
    history h = {.peak = 0};
    pyro_world w;
    pyro_desc desc = {.size = {cells, cells, cells}, .faces = {1, 1, 1, 1, 1, 1}};
    const theory_order mine = {order->device, order->shaders, order->fine, advection,
                               order->variable_density};
    theory_open(&mine, c, &w, &desc, pi / cells);
    c->note_count--; // the size is in the name of its line
    // A step moves the fastest air by two thirds of a cell.
    const int steps = (int)ceil(0.25 * 1.5 * cells / pi);
    w.numbers.gravity = 0;
    w.numbers.dt = (float)(0.25 / steps);
    pyro_for_each(&w, swirl, NULL);
    pyro_transfer(&w, true);
    const double unit = 0.125 / energy(&w);
    h.energy[0] = 0.125;
    for (int i = 1; i <= LOOKS; i++) {
        theory_step(c, &w, steps);
        h.energy[i] = energy(&w) * unit;
    }
    pyro_close(&w);
    for (int i = 2; i <= LOOKS; i++) { // over half a unit of time
        const double rate = (h.energy[i - 2] - h.energy[i]) / 0.5;
        if (rate > h.peak) h.peak = rate, h.peak_at = 0.25 * (i - 1);
    }
    return h;
}

void theory_vortex(const theory_order *order, theory_check *c) {
    c->name = "vortex";
    c->title = "A Taylor-Green vortex falls apart";
    c->source = "Brachet et al., J. Fluid Mech. 130 (1983); van Rees et al., J. Comput. Phys. 230 "
                "(2011): at Re 1600 dissipation peaks at 0.0126, near t = 9";
    theory_plot *kept = theory_add_plot(c, "Energy over time", "time", "energy");
    theory_plot *lost = theory_add_plot(c, "Dissipation", "time", "-dE/dt");
    const uint32_t most = theory_cells(order, 32);
    history finest = {.peak = 0};
    for (pyro_advection a = PYRO_UPWIND; a <= PYRO_REFLECTION; a++)
        for (uint32_t n = most / 2; n <= most; n += most / 2) {
            if (n < PYRO_LEAST_SIZE) continue;
            char name[64];
            snprintf(name, sizeof name, "%s %u", pyro_advection_names[a], 2 * n);
            const history h = run(order, c, a, n);
            theory_series *e = theory_add_series(c, kept, name, LOOKS + 1);
            theory_series *d = theory_add_series(c, lost, name, LOOKS + 1);
            for (int i = 0; i <= LOOKS; i++) theory_add(e, 0.25 * i, h.energy[i]);
            for (int i = 1; i < LOOKS; i++)
                theory_add(d, 0.25 * i, (h.energy[i - 1] - h.energy[i + 1]) / 0.5);
            if (a == order->advection && n == most) finest = h;
        }
    theory_series *known = theory_add_series(c, lost, "Re 1600", 1);
    known->expected = known->marks = true;
    theory_add(known, 9, 0.0126);
    theory_note(c,
                "Lines are named by the cells across the whole vortex. Figures are of the finest");
    // While all is smooth nothing is lost but by viscosity: 2 x 0.375 / 1600 a unit of time and
    // little more until t = 2.
    theory_near(c, "energy at t = 2", finest.energy[8] / 0.125, 1, 0.02, "of that at first");
    theory_near(c, "greatest dissipation", finest.peak, 0.0126, 0.10, "");
    theory_near(c, "time of the greatest dissipation", finest.peak_at, 9, 0.10, "");
}
