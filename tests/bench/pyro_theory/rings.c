// Two vortex rings that leapfrog, against thin rings that carry each other.
#include "theory.h"

static const double pi = 3.14159265358979;
enum { RINGS = 2 };

typedef struct ring { // of circulation 1; cells
    double radius, height, core;
} ring;

// The vector potential around the axis of a ring whose threads are softened by its core (Rosenhead
// and Moore), at a distance from the axis and a height above it.
static double potential_of(const ring *g, double r, double z) {
    enum { PARTS = 96 };
    double sum = 0;
    for (int i = 0; i < PARTS; i++) {
        const double a = cos(2 * pi * (i + 0.5) / PARTS);
        const double d2 = r * r + g->radius * g->radius - 2 * r * g->radius * a + z * z;
        sum += a * g->radius / sqrt(d2 + g->core * g->core);
    }
    return sum / (2 * PARTS);
}

// ---- theory -----------------------------------------------------------------------------------

// Each ring moves by itself (Saffman, Vortex Dynamics, 10.2) and by the other. Its core keeps its
// volume.
static void rates(const ring g[RINGS], double radius[RINGS], double height[RINGS]) {
    const double e = 1e-3;
    for (int i = 0; i < RINGS; i++) {
        const ring *o = &g[1 - i];
        const double r = g[i].radius, z = g[i].height - o->height;
        radius[i] = -(potential_of(o, r, z + e) - potential_of(o, r, z - e)) / (2 * e);
        height[i] = ((r + e) * potential_of(o, r + e, z) - (r - e) * potential_of(o, r - e, z)) /
                    (2 * e * r);
        height[i] += (log(8 * r / g[i].core) - 1) / (4 * pi * r);
    }
}

static void advance(ring g[RINGS], double dt) { // by the middle of the step
    double radius[RINGS], height[RINGS];
    ring middle[RINGS];
    rates(g, radius, height);
    for (int pass = 0; pass < 2; pass++) {
        const double h = pass == 0 ? dt / 2 : dt;
        for (int i = 0; i < RINGS; i++) {
            middle[i] = g[i];
            middle[i].radius += h * radius[i];
            middle[i].height += h * height[i];
            middle[i].core = g[i].core * sqrt(g[i].radius / middle[i].radius);
        }
        if (pass == 0) rates(middle, radius, height);
    }
    memcpy(g, middle, sizeof middle);
}

// ---- the solver -------------------------------------------------------------------------------

typedef struct scene {
    ring rings[RINGS];
} scene;

// A of all rings at the middle of an edge along x (0) or y (1).
static double edge(const scene *s, pyro_world *w, const double p[3], int axis) {
    const double x = p[0] - w->desc.size[0] / 2.0, y = p[1] - w->desc.size[1] / 2.0;
    const double r = sqrt(x * x + y * y);
    double a = 0;
    if (r < 1e-9) return 0;
    for (int i = 0; i < RINGS; i++) a += potential_of(&s->rings[i], r, p[2] - s->rings[i].height);
    return axis == 0 ? -y / r * a : x / r * a;
}

// By Stokes: what goes around a face is what flows through it. Gas in a core is marked by fuel, or
// by soot.
static void stir(pyro_world *w, const int c[3], void *data) {
    const scene *s = data;
    const double x = c[0], y = c[1], z = c[2];
    const double ax = edge(s, w, (double[3]){x + 0.5, y, z}, 0);
    const double ay = edge(s, w, (double[3]){x, y + 0.5, z}, 1);
    *pyro_face_at(w, 0, c) = (float)(ay - edge(s, w, (double[3]){x, y + 0.5, z + 1}, 1));
    *pyro_face_at(w, 1, c) = (float)(edge(s, w, (double[3]){x + 0.5, y, z + 1}, 0) - ax);
    *pyro_face_at(w, 2, c) = (float)(edge(s, w, (double[3]){x + 1, y + 0.5, z}, 1) - ay -
                                     edge(s, w, (double[3]){x + 0.5, y + 1, z}, 0) + ax);
    const double i = x + 0.5 - w->desc.size[0] / 2.0, k = y + 0.5 - w->desc.size[1] / 2.0;
    for (int n = 0; n < RINGS; n++) {
        const ring *g = &s->rings[n];
        const double a = sqrt(i * i + k * k) - g->radius, b = z + 0.5 - g->height;
        const double mark = exp(-(a * a + b * b) / (g->core * g->core));
        w->gas[pyro_cell_at(w, c)][n == 0 ? 1 : 3] = (float)(0.01 * mark);
    }
}

typedef struct place {
    double sum[RINGS], height[RINGS], radius[RINGS];
} place;

static void find(pyro_world *w, const int c[3], void *data) {
    place *p = data;
    const double i = c[0] + 0.5 - w->desc.size[0] / 2.0, k = c[1] + 0.5 - w->desc.size[1] / 2.0;
    for (int n = 0; n < RINGS; n++) {
        // Squares, so that what has been mixed far away counts little.
        const double m = pow((double)w->gas[pyro_cell_at(w, c)][n == 0 ? 1 : 3], 2);
        p->sum[n] += m;
        p->height[n] += m * (c[2] + 0.5);
        p->radius[n] += m * sqrt(i * i + k * k);
    }
}

// The times at which a line crosses 0, by interpolation. How many there are.
static size_t crossings(const theory_series *s, double out[8]) {
    size_t count = 0;
    for (size_t i = 1; i < s->count && count < 8; i++) {
        const double *a = s->points[i - 1], *b = s->points[i];
        if ((a[1] < 0) != (b[1] < 0)) out[count++] = a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1]);
    }
    return count;
}

void theory_rings(const theory_order *order, theory_check *c) {
    c->name = "rings";
    c->title = "Two vortex rings leapfrog";
    c->source =
        "Thin rings that carry each other (Dyson, Phil. Trans. A 184, 1893; Saffman, Vortex "
        "Dynamics, section 10.2), of the same softened threads";
    const uint32_t wide = theory_cells(order, 40), high = theory_cells(order, 96);
    const double u = wide / 40.0; // cells by those of the coarse size
    scene s = {.rings = {{8 * u, 20 * u, 1.8 * u}, {8 * u, 28 * u, 1.8 * u}}};
    ring thin[RINGS];
    memcpy(thin, s.rings, sizeof thin);
    pyro_world w;
    theory_open(order, c, &w, &(pyro_desc){.size = {wide, wide, high}}, 1);
    w.numbers.gravity = 0;
    w.numbers.ignition = 1e9f;
    enum { LOOKS = 60 };
    const double dt = 12 * u; // circulation is 1 cell^2/s, times go by u^2
    const int between = (int)round(2 * u);
    w.numbers.dt = (float)dt;
    pyro_for_each(&w, stir, &s);
    pyro_transfer(&w, true);
    theory_plot *apart = theory_add_plot(c, "How far the first is above the second",
                                         "time, radius^2 / circulation", "radii");
    theory_plot *path = theory_add_plot(c, "Radius by height", "height, radii", "radius, radii");
    theory_series *known = theory_add_series(c, apart, "thin rings", LOOKS + 1);
    theory_series *seen = theory_add_series(c, apart, "solver", LOOKS + 1);
    theory_series *ways[RINGS], *thin_ways[RINGS];
    for (int n = 0; n < RINGS; n++) {
        thin_ways[n] = theory_add_series(c, path, n ? "thin, second" : "thin, first", LOOKS + 1);
        ways[n] = theory_add_series(c, path, n ? "second" : "first", LOOKS + 1);
        thin_ways[n]->expected = true;
    }
    known->expected = true;
    for (int i = 0; i <= LOOKS; i++) {
        const double t = i * between * dt / pow(8 * u, 2);
        place p = {{0}, {0}, {0}};
        pyro_transfer(&w, false);
        pyro_for_each(&w, find, &p);
        for (int n = 0; n < RINGS; n++) {
            const double z = p.height[n] / p.sum[n], r = p.radius[n] / p.sum[n];
            theory_add(ways[n], z / (8 * u), r / (8 * u));
            theory_add(thin_ways[n], thin[n].height / (8 * u), thin[n].radius / (8 * u));
        }
        theory_add(seen, t, (p.height[0] / p.sum[0] - p.height[1] / p.sum[1]) / (8 * u));
        theory_add(known, t, (thin[0].height - thin[1].height) / (8 * u));
        theory_step(c, &w, between);
        for (int k = 0; k < 8 * between; k++) advance(thin, dt / 8);
    }
    pyro_close(&w);
    double a[8], b[8];
    const size_t passes = crossings(known, a), seen_passes = crossings(seen, b);
    theory_note(c, "Radius %.0f cells, core %.1f, a radius apart", 8 * u, 1.8 * u);
    theory_near(c, "time of the first pass", seen_passes > 0 ? b[0] : (double)NAN, a[0], 0.10,
                "radius^2 / circulation");
    theory_between(c, "passes before they merge", (double)seen_passes, 1, (double)passes, "");
}
