// The plume above a small source of heat, against Morton, Taylor and Turner.
#include "burner.h"

static const double pi = 3.14159265358979;
static const double height = 3.2; // of the box, m
static const double power = 150;  // W: gas is some 30 K warmer where it is first looked at

static double top_hat(const burner_level *l) { // radius of the flux of volume and of momentum, m
    return l->volume / sqrt(pi * l->momentum);
}

// Of gas that is so much warmer, m/s^2.
static double reduced_gravity(double warmth) {
    return 9.81 * warmth / (293 + warmth);
}

typedef struct law { // y = factor (z - origin)^exponent, by logarithms
    double factor, exponent;
} law;

static law fit_law(const double *z, const double *y, size_t count, double origin) {
    double lx[PYRO_MOST_SIZE], ly[PYRO_MOST_SIZE], a, b;
    for (size_t i = 0; i < count; i++) lx[i] = log(z[i] - origin), ly[i] = log(y[i]);
    theory_fit(lx, ly, count, &a, &b);
    return (law){exp(a), b};
}

// The mean of y (z - origin)^-exponent.
static double factor_of(const double *z, const double *y, size_t count, double origin,
                        double exponent) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += y[i] * pow(z[i] - origin, -exponent);
    return sum / (double)count;
}

typedef struct profile {
    double z[PYRO_MOST_SIZE], b[PYRO_MOST_SIZE], w[PYRO_MOST_SIZE], g[PYRO_MOST_SIZE];
    size_t count;
    double origin, slope; // of b
} profile;

static void draw(theory_check *c, const profile *p, double flux) {
    theory_plot *plots[] = {
        theory_add_plot(c, "Radius", "height, m", "b, m"),
        theory_add_plot(c, "Speed on the axis", "height above its origin, m", "w, m/s"),
        theory_add_plot(c, "Reduced gravity on the axis", "height above its origin, m",
                        "g', m/s^2"),
    };
    theory_series *seen[3], *least[3], *most[3];
    static const char *const low[] = {"alpha 0.10", "3.4 F^1/3 z^-1/3", "9.1 F^2/3 z^-5/3"};
    static const char *const high[] = {"alpha 0.13", "3.9 F^1/3 z^-1/3", "14.3 F^2/3 z^-5/3"};
    for (int i = 0; i < 3; i++) {
        least[i] = theory_add_series(c, plots[i], low[i], p->count);
        most[i] = theory_add_series(c, plots[i], high[i], p->count);
        seen[i] = theory_add_series(c, plots[i], "solver", p->count);
        least[i]->expected = most[i]->expected = true;
        plots[i]->log_x = plots[i]->log_y = i > 0;
    }
    for (size_t i = 0; i < p->count; i++) {
        const double z = p->z[i] - p->origin, third = pow(z, -1.0 / 3), five = pow(z, -5.0 / 3);
        theory_add(seen[0], p->z[i], p->b[i]);
        theory_add(least[0], p->z[i], 1.2 * 0.10 * z);
        theory_add(most[0], p->z[i], 1.2 * 0.13 * z);
        theory_add(seen[1], z, p->w[i]);
        theory_add(least[1], z, 3.4 * cbrt(flux) * third);
        theory_add(most[1], z, 3.9 * cbrt(flux) * third);
        theory_add(seen[2], z, p->g[i]);
        theory_add(least[2], z, 9.1 * pow(flux, 2.0 / 3) * five);
        theory_add(most[2], z, 14.3 * pow(flux, 2.0 / 3) * five);
    }
}

// What lifts the gas between two heights makes its flux of momentum grow, whatever is mixed in.
static double momentum_by_lift(const burner_seen *s, double cell, size_t low, size_t high) {
    double lift = 0;
    for (size_t z = low; z < high; z++)
        lift += 0.5 * (s->levels[z].lift + s->levels[z + 1].lift) * cell;
    return (s->levels[high].momentum_all - s->levels[low].momentum_all) / lift;
}

void theory_plume(const theory_order *order, theory_check *c) {
    c->name = "plume";
    c->title = "A plume entrains air";
    c->source =
        "Morton, Taylor and Turner, Proc. R. Soc. A 234 (1956): b = 6/5 alpha z, "
        "w ~ z^-1/3, g' ~ z^-5/3, alpha 0.10 to 0.13; factors on the axis by George, Alpert "
        "and Tamanini (1977), and Papanicolaou and List (1988)";
    const uint32_t wide = theory_cells(order, 32), high = theory_cells(order, 56);
    const double cell = height / high;
    const burner_desc d = {
        .size = {wide, wide, high},
        .cell = cell,
        .width = 0.4,
        .power = power,
        .heat = 3e7,
        .oxygen = 3,
        .molar_mass = 29,
        .dt = cell,
        .settle = 12,
        .last = 30,
        .look = 0.25,
        .flame = 500,
    };
    const burner_seen s = burner_run(order, c, &d);
    const size_t low = (size_t)(0.35 * (double)s.count), top = (size_t)(0.85 * (double)s.count);
    const double flux = 9.81 * power / (353 * 1150); // of buoyancy, m^4/s^3
    profile *p = mem_alloc(sizeof *p);
    p->count = 0;
    for (size_t z = low; z <= top; z++) {
        const burner_level *l = &s.levels[z];
        p->z[p->count] = ((double)z + 0.5) * cell;
        p->b[p->count] = top_hat(l);
        p->w[p->count] = l->w;
        p->g[p->count++] = reduced_gravity(l->warmth);
    }
    double a;
    theory_fit(p->z, p->b, p->count, &a, &p->slope);
    p->origin = -a / p->slope;
    draw(c, p, flux);
    burner_draw_heat(c, burner_plot_heat(c), "solver", &d, &s);
    const law w = fit_law(p->z, p->w, p->count, p->origin);
    const law g = fit_law(p->z, p->g, p->count, p->origin);
    theory_note(c,
                "%.0f W from a disc of %.2g m, means of %.0f s, looked at from %.2f to %.2f m; "
                "origin at %.2f m",
                power, d.width, d.last, p->z[0], p->z[p->count - 1], p->origin);
    theory_between(c, "alpha, 5/6 of the slope of b", 5.0 / 6 * p->slope, 0.10 * 0.85, 0.13 * 1.15,
                   "");
    theory_near(c, "exponent of speed", w.exponent, -1.0 / 3, 0.15, "");
    theory_near(c, "exponent of reduced gravity", g.exponent, -5.0 / 3, 0.15, "");
    theory_between(c, "factor of speed, w z^1/3 F^-1/3",
                   factor_of(p->z, p->w, p->count, p->origin, -1.0 / 3) / cbrt(flux), 3.4 * 0.85,
                   3.9 * 1.15, "");
    theory_between(c, "factor of reduced gravity, g' z^5/3 F^-2/3",
                   factor_of(p->z, p->g, p->count, p->origin, -5.0 / 3) / pow(flux, 2.0 / 3),
                   9.1 * 0.85, 14.3 * 1.15, "");
    theory_near(c, "momentum that is gained, by buoyancy", momentum_by_lift(&s, cell, low, top), 1,
                0.15, "");
    theory_near(c, "heat that passes at the top, by what is given", s.levels[top].heat / power, 1,
                0.10, "");
    mem_free(p);
}
