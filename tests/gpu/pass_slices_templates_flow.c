// What a flow makes of templates: sources and sinks, vortices, and eddies as large as they are.
#include "library_test.h"
#include "templates_test.h"

enum { SIDE = 64 };
static const flow_desc box = {.size = {SIDE, SIDE},
                              .slices = 1,
                              .solver = FLOW_MULTIGRID,
                              .faces = {FLOW_OPEN, FLOW_OPEN, FLOW_OPEN, FLOW_OPEN}};

static pass *add_library(templates_world *t, const char *name, const char *kind, uint32_t count) {
    pass *p = templates_add(t, library_picture(&t->w.memory, name), count);
    gpu_test_ok(pass_set_option(p, "kind", kind));
    return p;
}

// One in the middle, of 24 cells, which stays.
static pass *add_middle(templates_world *t, const char *name, const char *kind, float strength) {
    pass *p = add_library(t, name, kind, 1);
    const field *where = row(&t->w, "sphere", SET("position", triple(&t->w, 0.5f, 0.5f, 0)),
                             SET("radius", number(&t->w, 1e-4f)), SET("falloff", number(&t->w, 0)));
    gpu_test_ok(pass_set_field(p, "region", where));
    gpu_test_ok(pass_set_option(p, "align", "fixed"));
    templates_set(t, p, "size_min", 24.0f / SIDE);
    templates_set(t, p, "size_max", 24.0f / SIDE);
    templates_set(t, p, "strength", strength);
    templates_set(t, p, "fade", 0);
    templates_set(t, p, "lifetime_min", 1000);
    templates_set(t, p, "lifetime_max", 1000);
    return p;
}

// ---- what flows -------------------------------------------------------------------------------

typedef struct speeds { // staggered (sim/flow.h)
    float *uv;
    int row;
} speeds;

static speeds read_speeds(templates_world *t) {
    return (speeds){templates_read_flow(t, "FlowVelocity"), (SIDE + 4) / 4 * 4};
}

static double speed_at(const speeds *s, int x, int y, int axis) {
    return (double)s->uv[2 * (y * s->row + x) + axis];
}

// Out of a square of cells from `low` to `high` - 1, m/s times cells.
static double flux(const speeds *s, int low, int high) {
    double sum = 0;
    for (int i = low; i < high; i++) {
        sum += speed_at(s, high, i, 0) - speed_at(s, low, i, 0);
        sum += speed_at(s, i, high, 1) - speed_at(s, i, low, 1);
    }
    return sum;
}

// Anticlockwise along the middle of the cells around a square.
static double circulation(const speeds *s, int low, int high) {
    double sum = 0;
    for (int i = low; i < high; i++) {
        sum += speed_at(s, i, low, 0) - speed_at(s, i, high, 0);
        sum += speed_at(s, high, i, 1) - speed_at(s, low, i, 1);
    }
    return sum;
}

typedef struct flowing {
    double flux, circulation;
} flowing;

enum { RAISED, LOWERED, LEFT, RIGHT, PUSHED, TRIED };

// What one template of these has made of air at rest after ten steps.
static flowing flow_of(templates_world *t, int which, float strength) {
    for (int i = 0; i < TRIED; i++)
        templates_set(t, t->groups[i], "strength", i == which ? strength : 0);
    templates_reset(t);
    templates_run(t, 10, true);
    speeds s = read_speeds(t);
    flowing out = {flux(&s, SIDE / 2 - 14, SIDE / 2 + 14),
                   circulation(&s, SIDE / 2 - 6, SIDE / 2 + 6)};
    print_message("template %d, %g: flux %.3f, circulation %.3f\n", which, (double)strength,
                  out.flux, out.circulation);
    mem_free(s.uv);
    return out;
}

// Raised pressure is a source, lowered a sink (K11), as much stronger as the template is. Vortices
// turn as their names say (K12), and what velocities push apart is taken away.
static void pressure_makes_sources_and_velocity_vortices(void **state) {
    templates_world t;
    templates_open(&t, *state, &box, 1.0 / 60);
    add_middle(&t, "source", "pressure", 0);
    add_middle(&t, "sink", "pressure", 0);
    add_middle(&t, "vortex_left", "velocity", 0);
    add_middle(&t, "vortex_right", "velocity", 0);
    add_middle(&t, "source", "velocity", 0);
    templates_build(&t);
    flowing up = flow_of(&t, RAISED, 0.02f), twice = flow_of(&t, RAISED, 0.04f);
    flowing down = flow_of(&t, LOWERED, 0.02f), minus = flow_of(&t, RAISED, -0.02f);
    assert_true(up.flux > 0.2 && down.flux < -0.2);
    assert_true(twice.flux > 1.8 * up.flux);
    assert_true(fabs(down.flux - minus.flux) < 0.01 * fabs(minus.flux));
    assert_true(fabs(up.circulation) < 0.02 * up.flux);
    flowing left = flow_of(&t, LEFT, 2), right = flow_of(&t, RIGHT, 2);
    flowing pushed = flow_of(&t, PUSHED, 2);
    assert_true(left.circulation > 1);
    assert_true(fabs(left.circulation + right.circulation) < 0.02 * left.circulation);
    assert_true(fabs(left.flux) < 1e-2 * left.circulation);
    assert_true(fabs(pushed.flux) < 1e-2 * left.circulation);
    templates_close(&t);
}

// The flux of a source does not hang on the cells, of which there are twice as many, or on the
// step.
static void pressure_is_as_firm_on_other_cells_and_steps(void **state) {
    double seen[3];
    for (int k = 0; k < 3; k++) {
        templates_world t;
        flow_desc desc = box;
        desc.size[0] = desc.size[1] = k == 1 ? 2 * SIDE : SIDE;
        int steps = k == 2 ? 40 : 20;
        templates_open(&t, *state, &desc, 1.0 / 3 / steps);
        add_middle(&t, "source", "pressure", 0.05f);
        templates_build(&t);
        templates_run(&t, steps, true);
        float *uv = templates_read_flow(&t, "FlowVelocity");
        const speeds s = {uv, ((int)desc.size[0] + 4) / 4 * 4};
        int side = (int)desc.size[0], half = side * 14 / 64;
        seen[k] = flux(&s, side / 2 - half, side / 2 + half) / side;
        mem_free(uv);
        templates_close(&t);
    }
    print_message("flux %.4f m^2/s, of twice the cells %.4f, of twice the steps %.4f\n", seen[0],
                  seen[1], seen[2]);
    assert_true(fabs(seen[1] / seen[0] - 1) < 0.15 && fabs(seen[2] / seen[0] - 1) < 0.15);
}

// Gives each cell `value` of density and temperature where it is in the first `columns`.
static void fill(templates_world *t, int columns, float value) {
    gpu *device = t->w.host.device;
    gpu_buffer *scalars = flow_find(t->f.solver, "FlowScalars");
    assert_non_null(scalars);
    size_t size = (size_t)gpu_buffer_size(scalars);
    float *values = mem_alloc(size);
    for (int i = 0; i < SIDE * SIDE; i++)
        values[4 * i] = values[4 * i + 1] = i % SIDE < columns ? value : 0;
    gpu_test_ok(gpu_buffer_write(device, scalars, 0, values, size));
    mem_free(values);
}

// As strong as what the flow has there (K22), and where it has enough; there they look out of it.
static void templates_go_by_what_the_flow_has(void **state) {
    templates_world t;
    templates_open(&t, *state, &box, 1.0 / 60);
    pass *scaled = add_middle(&t, "source", "pressure", 0.5f);
    pass *within = add_library(&t, "source", "pressure", 64);
    gpu_test_ok(pass_set_option(scaled, "scale_by", "temperature"));
    gpu_test_ok(pass_set_option(within, "within", "density"));
    gpu_test_ok(pass_set_option(within, "align", "contour"));
    templates_set(&t, within, "above", 0.5f);
    templates_build(&t);
    for (int k = 0; k < 3; k++) {
        fill(&t, SIDE, (float)k);
        templates_run(&t, 1, false);
        template_seen *seen = templates_read(&t, 0);
        assert_true((seen->half_side > 0) == (k > 0));
        assert_true(fabsf(seen->factor - 0.5f * (float)k) < 1e-5f);
        for (int i = 1; i < 65; i++) assert_true((seen[i].half_side > 0) == (k > 0));
        mem_free(seen);
    }
    templates_reset(&t);
    fill(&t, 20, 1);
    templates_run(&t, 1, false);
    template_seen *seen = templates_read(&t, 0);
    int put = 0;
    for (int i = 1; i < 65; i++) {
        put += seen[i].put != 0;
        assert_true(seen[i].put == 0 || seen[i].x < 20);
        if (seen[i].put != 0 && seen[i].x > 12 && seen[i].y > 16 && seen[i].y < 48)
            assert_true(seen[i].sine < -0.9f); // the upper edge to the right
    }
    assert_true(put > 50);
    mem_free(seen);
    templates_close(&t);
}

// What a vortex has made of the flow, taken out as a picture, is a vortex with a low core.
static void what_flows_is_captured_as_a_picture(void **state) {
    templates_world t;
    templates_open(&t, *state, &box, 1.0 / 60);
    add_middle(&t, "vortex_left", "velocity", 20);
    templates_build(&t);
    picture seen;
    float scale[2];
    static const float place[2] = {0.5f, 0.5f};
    assert_false(slices_capture(t.f.pass, 0, place, 0.375f, &t.w.memory, &seen, scale));
    templates_run(&t, 20, true);
    assert_false(slices_capture(t.f.pass, 1, place, 0.375f, &t.w.memory, &seen, scale));
    gpu_test_ok(slices_capture(t.f.pass, 0, place, 0.375f, &t.w.memory, &seen, scale));
    print_message("captured %.3f m/s, %.4f m^2/s^2\n", (double)scale[0], (double)scale[1]);
    const int middle = TEMPLATE_TILE / 2, quarter = TEMPLATE_TILE / 4;
    const float *right = seen.rgba + 4 * (middle * TEMPLATE_TILE + middle + quarter);
    const float *above = seen.rgba + 4 * (quarter * TEMPLATE_TILE + middle);
    const float *core = seen.rgba + 4 * (middle * TEMPLATE_TILE + middle);
    assert_true(right[1] > 0.5f && fabsf(right[0]) < 0.2f);
    assert_true(above[0] < -0.5f && fabsf(above[1]) < 0.2f);
    assert_true(core[2] < -0.5f && core[3] > 0.99f && hypotf(core[0], core[1]) < 0.2f);
    assert_true(scale[0] > 0.2f && scale[1] > 0.01f);
    templates_close(&t);
}

// ---- frequencies ------------------------------------------------------------------------------

enum { BANDS = 3 }; // up to 3, up to 8, more waves across
static const int band_end[BANDS] = {3, 8, SIDE / 2};

typedef struct spectrum {
    double share[BANDS], mean; // of the energy; waves across, weighted by it
} spectrum;

// |F(k)|^2 of one component, along one axis after the other.
static void add_energy(const double *v, double *energy) {
    static double half[2][SIDE][SIDE];
    const double turn = 2 * 3.14159265358979 / SIDE;
    for (int y = 0; y < SIDE; y++)
        for (int k = 0; k < SIDE; k++) {
            half[0][y][k] = half[1][y][k] = 0;
            for (int x = 0; x < SIDE; x++) {
                half[0][y][k] += v[y * SIDE + x] * cos(turn * k * x);
                half[1][y][k] -= v[y * SIDE + x] * sin(turn * k * x);
            }
        }
    for (int l = 0; l < SIDE; l++)
        for (int k = 0; k < SIDE; k++) {
            double re = 0, im = 0;
            for (int y = 0; y < SIDE; y++) {
                double c = cos(turn * l * y), s = -sin(turn * l * y);
                re += half[0][y][k] * c - half[1][y][k] * s;
                im += half[0][y][k] * s + half[1][y][k] * c;
            }
            energy[l * SIDE + k] += re * re + im * im;
        }
}

static spectrum spectrum_of(const speeds *s) {
    static double v[SIDE * SIDE], energy[SIDE * SIDE];
    memset(energy, 0, sizeof energy);
    for (int axis = 0; axis < 2; axis++) {
        for (int i = 0; i < SIDE * SIDE; i++) v[i] = speed_at(s, i % SIDE, i / SIDE, axis);
        add_energy(v, energy);
    }
    spectrum out = {{0}, 0};
    double all = 0;
    for (int i = 1; i < SIDE * SIDE; i++) {
        int kx = i % SIDE, ky = i / SIDE;
        if (kx > SIDE / 2) kx -= SIDE;
        if (ky > SIDE / 2) ky -= SIDE;
        double k = sqrt(kx * kx + ky * ky);
        int band = 0;
        while (band < BANDS - 1 && k >= band_end[band]) band++;
        out.share[band] += energy[i];
        out.mean += k * energy[i];
        all += energy[i];
    }
    for (int b = 0; b < BANDS; b++) out.share[b] /= all;
    out.mean /= all;
    return out;
}

typedef struct stirring {
    float least, most, shortest, longest, strength;
} stirring;

static const stirring stirrings[BANDS] = {
    {0.6f, 0.9f, 0.3f, 1.0f, 2}, {0.18f, 0.26f, 0.1f, 0.3f, 4}, {0.06f, 0.09f, 0.02f, 0.1f, 100}};

static void add_stirring(templates_world *t, const stirring *s) {
    static const char *const names[2] = {"vortex_left", "vortex_right"};
    for (int k = 0; k < 2; k++) {
        pass *p = add_library(t, names[k], "velocity", 20);
        templates_set(t, p, "size_min", s->least);
        templates_set(t, p, "size_max", s->most);
        templates_set(t, p, "lifetime_min", s->shortest);
        templates_set(t, p, "lifetime_max", s->longest);
        templates_set(t, p, "strength", s->strength);
    }
}

// `bands`: bits of those that are stirred.
static spectrum stir(templates_world *t, unsigned bands) {
    for (unsigned i = 0; i < 2 * BANDS; i++)
        templates_set(t, t->groups[i], "amount", (bands >> (i / 2) & 1) ? 1 : 0);
    templates_reset(t);
    templates_run(t, 20, true);
    speeds s = read_speeds(t);
    spectrum out = spectrum_of(&s);
    print_message("bands %u: %.0f %% below 3 waves, %.0f %% to 8, %.0f %% above; mean %.1f\n",
                  bands, 100 * out.share[0], 100 * out.share[1], 100 * out.share[2], out.mean);
    mem_free(s.uv);
    return out;
}

// As published (Fig. 7): templates of equal shape and number make high, medium, low and all
// frequencies, by their sizes, lifetimes and strengths.
static void sizes_and_lifetimes_choose_the_frequencies(void **state) {
    static const flow_desc round = {
        .size = {SIDE, SIDE},
        .slices = 1,
        .solver = FLOW_MULTIGRID,
        .faces = {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC}};
    templates_world t;
    templates_open(&t, *state, &round, 1.0 / 60);
    for (int b = 0; b < BANDS; b++) add_stirring(&t, &stirrings[b]);
    templates_build(&t);
    spectrum low = stir(&t, 1), medium = stir(&t, 2), high = stir(&t, 4), all = stir(&t, 7);
    assert_true(high.mean > 1.5 * medium.mean && medium.mean > 1.5 * low.mean);
    assert_true(low.share[0] > 0.5 && medium.share[1] > 0.45 && high.share[2] > 0.7);
    for (int b = 0; b < BANDS; b++) assert_true(all.share[b] > 0.1 && all.share[b] < 0.7);
    templates_close(&t);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pressure_makes_sources_and_velocity_vortices),
        cmocka_unit_test(pressure_is_as_firm_on_other_cells_and_steps),
        cmocka_unit_test(templates_go_by_what_the_flow_has),
        cmocka_unit_test(what_flows_is_captured_as_a_picture),
        cmocka_unit_test(sizes_and_lifetimes_choose_the_frequencies),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
