// Fires on a burner and on a pool: how warm and fast they are on their axis, how high they reach,
// how often they puff.
#include "burner.h"

static const double pi = 3.14159265358979;
static const double ambient = 293;

// ---- McCaffrey's regions ----------------------------------------------------------------------

typedef struct region { // up to a height by Q^(2/5), m/kW^(2/5)
    const char *name;
    double from, to, k, eta;
} region;

static const region regions[] = {
    {"flame", 0.02, 0.08, 6.8, 0.5},
    {"intermittent", 0.08, 0.2, 1.9, 0},
    {"plume", 0.2, 0.6, 1.1, -1.0 / 3},
};
enum { REGIONS = COUNT_OF(regions) };

static double speed_of(const region *r, double z) { // by Q^(1/5), m/s
    return r->k * pow(z, r->eta);
}

static double warmth_of(const region *r, double z) { // K
    return pow(r->k / (0.9 * sqrt(2 * 9.81)), 2) * pow(z, 2 * r->eta - 1) * ambient;
}

// ---- puffs ------------------------------------------------------------------------------------

// Power at a frequency, with the window of Hann; of both series by their own variance.
static double power_at(const burner_seen *s, double frequency) {
    double power = 0;
    for (int k = 0; k < 2; k++) {
        double mean = 0, all = 0, re = 0, im = 0;
        for (size_t i = 0; i < s->looks; i++) mean += s->series[i][k] / (double)s->looks;
        for (size_t i = 0; i < s->looks; i++) {
            const double v = s->series[i][k] - mean, t = (double)i * s->step;
            const double window = 0.5 - 0.5 * cos(2 * pi * ((double)i + 0.5) / (double)s->looks);
            all += v * v;
            re += window * v * cos(2 * pi * frequency * t);
            im += window * v * sin(2 * pi * frequency * t);
        }
        power += (re * re + im * im) / (all * (double)s->looks);
    }
    return power;
}

// Draws power by f sqrt(D), up to four times what is expected. Returns the frequency that has most.
static double find_puffs(theory_check *c, theory_plot *p, const char *name, const burner_seen *s,
                         double diameter) {
    enum { TRIES = 180 };
    theory_series *line = theory_add_series(c, p, name, TRIES);
    double best = 0, most = 0;
    for (int i = 0; i < TRIES; i++) {
        const double scaled = 0.3 + 0.03 * i, power = power_at(s, scaled / sqrt(diameter));
        theory_add(line, scaled, power);
        if (power > most) most = power, best = scaled / sqrt(diameter);
    }
    return best;
}

// ---- fires ------------------------------------------------------------------------------------

typedef struct plots {
    theory_plot *warmth, *speed, *flame, *puffs, *heat;
} plots;

// The height below which there is a flame more than half of the time, m.
static double flame_height(const burner_seen *s, double cell) {
    size_t z = 0;
    while (z + 1 < s->count && s->levels[z + 1].flame > 0.5) z++;
    if (z + 1 == s->count) return NAN;
    const double a = s->levels[z].flame, b = s->levels[z + 1].flame;
    return ((double)z + 0.5 + (a - 0.5) / (a - b)) * cell;
}

static void look_at_fire(theory_check *c, const plots *p, const char *name, const burner_desc *d,
                         const burner_seen *s) {
    char text[128];
    const double q = d->power / 1e3;
    const double diameter = d->square ? d->width * sqrt(4 / pi) : d->width;
    const double high = 0.235 * pow(q, 0.4) - 1.02 * diameter;
    const double puffs = find_puffs(c, p->puffs, name, s, diameter);
    theory_series *flame = theory_add_series(c, p->flame, name, s->count);
    for (size_t z = 0; z < s->count; z++)
        theory_add(flame, ((double)z + 0.5) * d->cell / high, s->levels[z].flame);
    burner_draw_heat(c, p->heat, name, d, s);
    snprintf(text, sizeof text, "%s: height of the flame", name);
    theory_near(c, text, flame_height(s, d->cell), high, 0.15, "m");
    snprintf(text, sizeof text, "%s: puffs", name);
    theory_near(c, text, puffs, 1.5 / sqrt(diameter), 0.15, "1/s");
    snprintf(text, sizeof text, "%s: heat that passes at 0.8 of the box, by what is given", name);
    theory_near(c, text, s->levels[s->count * 4 / 5].heat / (d->power * (1 - d->radiated)), 1, 0.10,
                "");
    theory_note(c, "%s: a %s of %.2g m, %.3g of its heat radiated, means of %.0f s, %.1f puffs",
                name, d->square ? "square" : "disc", d->width, d->radiated, d->last,
                puffs * d->last);
}

// As high as the highest power.
static void draw_expected(theory_check *c, const plots *p) {
    double most = 0;
    for (size_t i = 0; i < p->puffs->count; i++)
        for (size_t k = 0; k < p->puffs->series[i].count; k++)
            most = fmax(most, p->puffs->series[i].points[k][1]);
    theory_series *puffs = theory_add_series(c, p->puffs, "1.5", 2);
    theory_series *flame = theory_add_series(c, p->flame, "Heskestad", 1);
    puffs->expected = flame->expected = flame->marks = true;
    theory_add(puffs, 1.5, 0);
    theory_add(puffs, 1.5, most);
    theory_add(flame, 1, 0.5);
}

static plots add_plots(theory_check *c, bool axis) {
    plots p = {0};
    if (axis) {
        p.warmth = theory_add_plot(c, "Warmth on the axis", "z / Q^2/5, m/kW^2/5", "dT, K");
        p.speed = theory_add_plot(c, "Speed on the axis", "z / Q^2/5, m/kW^2/5", "w / Q^1/5");
        p.warmth->log_x = p.warmth->log_y = p.speed->log_x = p.speed->log_y = true;
    }
    p.flame = theory_add_plot(c, "Share of time with a flame", "height by Heskestad's", "share");
    p.puffs = theory_add_plot(c, "Puffs: speed on the axis", "f sqrt(D)", "power");
    p.heat = burner_plot_heat(c);
    return p;
}

// ---- McCaffrey --------------------------------------------------------------------------------

typedef struct ratios { // sums of logarithms, of each region
    double warmth[REGIONS], speed[REGIONS], count[REGIONS];
} ratios;

static void compare_axis(theory_check *c, const plots *p, const char *name, const burner_desc *d,
                         const burner_seen *s, ratios *r) {
    const double q = d->power / 1e3;
    theory_series *warmth = theory_add_series(c, p->warmth, name, s->count);
    theory_series *speed = theory_add_series(c, p->speed, name, s->count);
    for (size_t i = 0; i < s->count * 17 / 20; i++) { // what is near the top feels its open face
        const double z = ((double)i + 0.5) * d->cell / pow(q, 0.4),
                     w = s->levels[i].w / pow(q, 0.2);
        const double t = s->levels[i].warmth;
        theory_add(warmth, z, t);
        theory_add(speed, z, w);
        for (int k = 0; k < REGIONS; k++) {
            const region *own = &regions[k];
            if (z < own->from || z >= own->to || w <= 0 || t <= 0) continue;
            r->warmth[k] += log(t / warmth_of(own, z));
            r->speed[k] += log(w / speed_of(own, z));
            r->count[k]++;
        }
    }
}

static void draw_regions(theory_check *c, const plots *p) {
    theory_series *warmth = theory_add_series(c, p->warmth, "McCaffrey", 2 * REGIONS);
    theory_series *speed = theory_add_series(c, p->speed, "McCaffrey", 2 * REGIONS);
    warmth->expected = speed->expected = true;
    for (int k = 0; k < REGIONS; k++)
        for (int end = 0; end < 2; end++) {
            const double z = end ? regions[k].to : regions[k].from;
            theory_add(warmth, z, warmth_of(&regions[k], z));
            theory_add(speed, z, speed_of(&regions[k], z));
        }
}

void theory_flames(const theory_order *order, theory_check *c) {
    c->name = "flames";
    c->title = "Flames on McCaffrey's burner";
    c->source =
        "McCaffrey, NBSIR 79-1910 (1979): warmth and speed on the axis of flames of natural "
        "gas; Heskestad, Fire Safety J. 5 (1983): height 0.235 Q^2/5 - 1.02 D; Cetegen and "
        "Ahmed, Combust. Flame 93 (1993): puffs 1.5 / sqrt(D)";
    static const struct {
        const char *name;
        double power, cell, dt;
        uint32_t high; // cells
    } fires[] = {{"57.5 kW", 57.5e3, 0.0375, 0.010, 56}, {"14.4 kW", 14.4e3, 0.030, 0.010, 48}};
    const plots p = add_plots(c, true);
    ratios r = {0};
    draw_regions(c, &p);
    for (size_t i = 0; i < COUNT_OF(fires); i++) {
        const uint32_t wide = theory_cells(order, 32);
        const double share = 32.0 / wide; // a cell by a coarse one
        const burner_desc d = {
            .size = {wide, wide, theory_cells(order, fires[i].high)},
            .cell = fires[i].cell * share,
            .width = 0.3,
            .square = true,
            .power = fires[i].power,
            .radiated = 0.15, // sim/fuels.c: methane
            .heat = 50.1e6,
            .oxygen = 3.99,
            .molar_mass = 16,
            .dt = fires[i].dt * share,
            .settle = 2.5,
            .last = 6,
            .look = 0.03,
            .flame = 500,
        };
        const burner_seen s = burner_run(order, c, &d);
        compare_axis(c, &p, fires[i].name, &d, &s, &r);
        look_at_fire(c, &p, fires[i].name, &d, &s);
    }
    draw_expected(c, &p);
    for (int k = 0; k < REGIONS; k++) {
        char text[128];
        snprintf(text, sizeof text, "warmth by McCaffrey's, %s", regions[k].name);
        theory_near(c, text, exp(r.warmth[k] / r.count[k]), 1, 0.20, "");
        snprintf(text, sizeof text, "speed by McCaffrey's, %s", regions[k].name);
        theory_near(c, text, exp(r.speed[k] / r.count[k]), 1, 0.20, "");
    }
}

// ---- a pool -----------------------------------------------------------------------------------

void theory_pool(const theory_order *order, theory_check *c) {
    c->name = "pool";
    c->title = "A pool of petrol burns";
    c->source = "Heskestad, Fire Safety J. 5 (1983): height 0.235 Q^2/5 - 1.02 D; Cetegen and "
                "Ahmed, Combust. Flame 93 (1993): puffs 1.5 / sqrt(D)";
    const uint32_t wide = theory_cells(order, 32);
    const double share = 32.0 / wide;
    const burner_desc d = {
        .size = {wide, wide, theory_cells(order, 48)},
        .cell = 0.125 * share,
        .width = 1,
        .power = 1.57e6,  // 2 MW/m^2
        .radiated = 0.35, // sim/fuels.c: petrol
        .heat = 43.7e6,
        .oxygen = 3.4,
        .molar_mass = 105,
        .dt = 0.016 * share,
        .settle = 4,
        .last = 12,
        .look = 0.064,
        .flame = 500,
    };
    const plots p = add_plots(c, false);
    const burner_seen s = burner_run(order, c, &d);
    look_at_fire(c, &p, "1.57 MW", &d, &s);
    draw_expected(c, &p);
}
