// A cloud of vapour that burns as a fireball: how large it becomes, and how long it lasts.
#include "theory.h"

static const double pi = 3.14159265358979;
// Here both laws of duration, 0.45 M^(1/3) for clouds that mix by the momentum of their release and
// 2.6 M^(1/6) for those that mix by their buoyancy, say about the same: 14.0 and 14.5 s.
static const double mass = 30000; // of propane, kg
static const double rich = 0.25;  // fuel by mass of air in the cloud at first
static const double ambient = 293;
static const double flame = 500; // K above the surroundings, from which gas is seen

typedef struct cloud {
    double radius, height; // m
} cloud;

// The cloud begins at rest on the ground, uneven by a tenth.
static void fill(pyro_world *w, const int c[3], void *data) {
    const cloud *b = data;
    const double cell = (double)w->numbers.cell;
    const double x = (c[0] + 0.5 - w->desc.size[0] / 2.0) * cell;
    const double y = (c[1] + 0.5 - w->desc.size[1] / 2.0) * cell;
    const double z = (c[2] + 0.5) * cell - b->height;
    const double in = fmin(1, fmax(0, (b->radius - sqrt(x * x + y * y + z * z)) / cell + 0.5));
    const double wave = sin(0.31 * x + 1) * sin(0.27 * y + 2) * sin(0.23 * z + 0.5);
    w->gas[pyro_cell_at(w, c)][1] = (float)(in * rich * (1 + 0.1 * wave));
}

// Diameter of the circle that covers as much as the flame does, seen from the side, m.
static double diameter(pyro_world *w) {
    const int *n = (const int *)w->desc.size;
    double area = 0;
    for (int z = 0; z < n[2]; z++)
        for (int x = 0; x < n[0]; x++) {
            double hottest = 0;
            for (int y = 0; y < n[1]; y++)
                hottest = fmax(hottest, (double)w->gas[pyro_cell_at(w, (int[3]){x, y, z})][0]);
            area += hottest > flame;
        }
    return sqrt(4 * area / pi) * (double)w->numbers.cell;
}

// ---- room -------------------------------------------------------------------------------------

// What flows out of the box, a cell within its faces, m^3/s. Its ground is a wall.
static double outflow(pyro_world *w) {
    const int *n = (const int *)w->desc.size;
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int i = a == 2 ? 0 : 1; i < n[a] - 1; i++)
            for (int k = b == 2 ? 0 : 1; k < n[b] - 1; k++) {
                int c[3];
                c[a] = i, c[b] = k;
                c[axis] = n[axis] - 1;
                sum += (double)*pyro_face_at(w, axis, c);
                c[axis] = 1;
                if (axis < 2) sum -= (double)*pyro_face_at(w, axis, c);
            }
    }
    return sum * pow((double)w->numbers.cell, 2);
}

// The room that burning makes by theory, of the state as it is, m^3/s: at one pressure gas takes as
// much more of it as a flame warms it, with the fuel in it (Rehm and Baum 1978).
static double room(const pyro_world *w) {
    const pyro_numbers *n = &w->numbers;
    const double share = 1 - exp(-(double)n->dt / (double)n->burn_time), need = (double)n->oxygen;
    double sum = 0;
    for (size_t i = 0; i < w->cells; i++) {
        const double t = ambient + (double)w->gas[i][0], fuel = (double)w->gas[i][1];
        const double burnt = (double)w->gas[i][2], left = fmax(0.232 - need * burnt, 0) / need;
        const double now = share * fmin(fmax(fuel, 0), left);
        sum += (double)n->heat / 1150 * now / (1 + fuel + burnt) / t;
    }
    return sum * pow((double)n->cell, 3) / (double)n->dt;
}

void theory_fireball(const theory_order *order, theory_check *c) {
    c->name = "fireball";
    c->title = "A fireball";
    c->source = "Roberts, Fire Safety J. 4 (1982), as used by CCPS: D = 5.8 M^1/3 m, "
                "t = 0.45 M^1/3 s";
    const double wanted = 5.8 * cbrt(mass), time = 0.45 * cbrt(mass);
    const uint32_t wide = theory_cells(order, 40), high = theory_cells(order, 56);
    const double cell = 288.0 / wide, dt = 0.1 * 40 / wide;
    pyro_world w;
    theory_open(order, c, &w, &(pyro_desc){.size = {wide, wide, high}, .faces = {[4] = PYRO_WALL}},
                cell);
    pyro_numbers *n = &w.numbers;
    n->dt = (float)dt;
    n->ambient = (float)ambient;
    n->gravity = 9.81f;
    n->ignition = 0;
    n->burn_time = (float)sqrt(2 * cell / 9.81); // in which gravity mixes a cell
    n->heat = (float)(46e6 * (1 - 0.29));        // sim/fuels.c: propane
    n->oxygen = 3.63f;
    n->molar_mass = 44.1f;
    cloud b = {.radius = cbrt(3 * mass / rich / (353 / ambient) / (4 * pi))};
    b.height = b.radius;
    pyro_for_each(&w, fill, &b);
    pyro_transfer(&w, true);
    double given = 0;
    for (size_t i = 0; i < w.cells; i++)
        given += (double)w.gas[i][1] * 353 / ambient * pow(cell, 3);
    enum { LOOKS = 60 };
    const int between = (int)ceil(2 * time / LOOKS / dt);
    theory_plot *size = theory_add_plot(c, "Diameter", "time, s", "m");
    theory_plot *fuel = theory_add_plot(c, "Fuel", "time, s", "kg");
    theory_series *seen = theory_add_series(c, size, "solver", LOOKS + 1);
    theory_series *burnt = theory_add_series(c, fuel, "burnt", LOOKS + 1);
    theory_series *all = theory_add_series(c, fuel, "burnt and left", LOOKS + 1);
    theory_series *law = theory_add_series(c, size, "5.8 M^1/3 by 0.45 M^1/3", 3);
    law->expected = true;
    theory_add(law, 0, wanted), theory_add(law, time, wanted), theory_add(law, time, 0);
    double most = 0, ends = NAN, sum = 0, made = 0, out = 0;
    for (int i = 1; i <= LOOKS; i++) {
        theory_step(c, &w, between - 1);
        pyro_transfer(&w, false);
        made += room(&w); // in the step that comes
        theory_step(c, &w, 1);
        const pyro_report r = pyro_look_at(&w);
        const double t = i * between * dt;
        pyro_transfer(&w, false);
        out += outflow(&w);
        const double d = diameter(&w);
        theory_add(seen, t, d);
        theory_add(burnt, t, (double)r.burnt);
        sum = fmax(sum, (double)r.burnt + (double)r.fuel);
        theory_add(all, t, (double)r.burnt + (double)r.fuel);
        most = fmax(most, d);
        if (isnan(ends) && (double)r.fuel < 0.05 * given) ends = t;
    }
    pyro_close(&w);
    theory_note(
        c,
        "%.0f kg of propane, at first %.2g kg in 1 kg of air, at rest, burn time %.2g s; it "
        "ends when less than 5 %% is left",
        mass, rich, (double)n->burn_time);
    theory_near(c, "greatest diameter", most, wanted, 0.25, "m");
    theory_near(c, "duration", ends, time, 0.25, "s");
    theory_near(c, "most fuel that there was, burnt and left, by what was given", sum / given, 1,
                0.02, "");
    // What mixes within the step burns in it, too: some hundredths more than the state before has.
    theory_near(c, "room that burning makes: what flows out, by theory", out / made, 1, 0.10, "");
}
