#include "burner.h"
#include "kernel/kernel.h"

#define NAMES(NAME)                                                                                \
    NAME(middle), NAME(radius), NAME(square), NAME(give), NAME(flicker), NAME(seed),               \
        NAME(ambient), NAME(lightness), NAME(PyroGas)
enum { NAMES(KERNEL_NAME_ID) };
static const char *const names[] = {NAMES(KERNEL_NAME_TEXT)};

static const double air = 353;            // density by temperature of the solver's air, kg K/m^3
static const double heat_capacity = 1150; // of its air, J/(kg K)
static const double gravity = 9.81;

typedef struct burner {
    const burner_desc *desc;
    pyro_world w;
    shader_library *library;
    kernel kernel;
    burner_level *sums;
    double *cell_sums; // by cell: upwards velocity, its square, warmth, and their product
    size_t looks;
} burner;

enum { SUMS = 4 }; // of a cell

// ---- the source -------------------------------------------------------------------------------

static void make_kernel(burner *b, const theory_order *order) {
    char shaders[4200];
    shader_define defines[PYRO_MAX_DEFINES];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    b->library = shader_library_create(
        &(shader_library_desc){.shader_root = shaders, .effect_root = order->shaders});
    const kernel_source source = {
        .label = "burner",
        .stages = {{.name = "burner.comp",
                    .stage = SHADER_COMPUTE,
                    .defines = defines,
                    .define_count = pyro_defines(b->w.solver, defines)}},
        .stage_count = 1,
        .names = {names, COUNT_OF(names)},
    };
    gpu_test_ok(kernel_compile(&b->kernel, b->library, &b->w.memory, &source));
    gpu_test_ok(kernel_build(&b->kernel, b->w.device));
}

// Cells of the source, as its shader counts them.
static double source_cells(const burner_desc *d) {
    const double half = d->width / d->cell / 2;
    double sum = 0;
    for (uint32_t y = 0; y < d->size[1]; y++)
        for (uint32_t x = 0; x < d->size[0]; x++) {
            const double i = fabs(x + 0.5 - d->size[0] / 2.0), k = fabs(y + 0.5 - d->size[1] / 2.0);
            const double a = fmin(1, fmax(0, half - i + 0.5)), e = fmin(1, fmax(0, half - k + 0.5));
            sum += d->square ? a * e : fmin(1, fmax(0, half - sqrt(i * i + k * k) + 0.5));
        }
    return sum;
}

static void give(burner *b, uint64_t step) {
    enum { FLICKERS = 4 }; // steps for which the source is the same
    const burner_desc *d = b->desc;
    kernel *k = &b->kernel;
    gpu_buffer *buffers[PYRO_STATE_BUFFERS];
    pyro_buffers(b->w.solver, buffers);
    const float middle[2] = {(float)d->size[0] / 2, (float)d->size[1] / 2};
    const double volume = source_cells(d) * pow(d->cell, 3);
    kernel_set(k, N_middle, middle, sizeof middle);
    kernel_set_float(k, N_radius, (float)(d->width / d->cell / 2));
    kernel_set_int(k, N_square, d->square);
    kernel_set_float(k, N_give, (float)(d->power / d->heat * d->dt / volume));
    kernel_set_float(k, N_flicker, 0.2f);
    kernel_set_int(k, N_seed, (int32_t)(step / FLICKERS));
    kernel_set_float(k, N_ambient, b->w.numbers.ambient);
    kernel_set_float(k, N_lightness, 1);
    kernel_bind_buffer(k, N_PyroGas, buffers[1]);
    gpu_test_ok(kernel_run(k, b->w.device, d->size[0], d->size[1], 1));
}

static void steps(burner *b, theory_check *c, int count) {
    gpu *g = b->w.device;
    for (int left = count; left > 0;) {
        gpu_test_ok(gpu_frame_begin(g));
        for (int i = 0; i < 8 && left > 0; i++, left--) {
            give(b, pyro_steps(b->w.solver));
            gpu_test_ok(pyro_step(b->w.solver, g, &b->w.numbers, false));
        }
        gpu_test_ok(gpu_frame_end(g));
    }
    c->cells += (double)b->w.cells * count;
}

// ---- looks ------------------------------------------------------------------------------------

// Upwards in the middle of a cell. The face on top of the last one is taken to be as that below.
static double rise(pyro_world *w, const int c[3]) {
    int above[3] = {c[0], c[1], c[2]};
    if (c[2] + 1 < (int)w->desc.size[2]) above[2]++;
    return 0.5 * ((double)*pyro_face_at(w, 2, c) + (double)*pyro_face_at(w, 2, above));
}

// Upwards acceleration by buoyancy, as the gas's density says: (1 - r) / mean density, since
// pressure has one density everywhere (src/sim/pyro.md).
static double lift_of(const burner *b, double warmth) {
    const double r = (double)b->w.numbers.ambient / ((double)b->w.numbers.ambient + warmth);
    return gravity * 2 * (1 - r) / (1 + r);
}

// At a height: flux of heat, what is on the axis, whether there is a flame.
static double look_at(burner *b, int z, burner_level *l) {
    pyro_world *w = &b->w;
    const int nx = (int)w->desc.size[0], ny = (int)w->desc.size[1];
    const double area = pow(b->desc->cell, 2), ambient = (double)w->numbers.ambient;
    double hottest = 0, axis = 0;
    for (int y = 0; y < ny; y++)
        for (int x = 0; x < nx; x++) {
            const int c[3] = {x, y, z};
            const double up = rise(w, c), warmth = (double)w->gas[pyro_cell_at(w, c)][0];
            double *sums = b->cell_sums + SUMS * (size_t)(x + nx * (y + ny * z));
            sums[0] += up, sums[1] += up * up, sums[2] += warmth, sums[3] += warmth * up;
            hottest = fmax(hottest, warmth);
            l->momentum_all += up * up * area;
            l->lift += lift_of(b, warmth) * area;
            l->heat += air * heat_capacity * warmth / (ambient + warmth) * up * area;
            if (abs(2 * x + 1 - nx) > 1 || abs(2 * y + 1 - ny) > 1) continue;
            axis += up / 4;
            l->warmth += warmth / 4;
        }
    l->w += axis;
    l->flame += hottest > b->desc->flame;
    return axis;
}

static void look(burner *b, burner_seen *s) {
    const double width = b->desc->width / b->desc->cell;
    pyro_transfer(&b->w, false);
    for (size_t z = 0; z < s->count; z++) {
        const double up = look_at(b, (int)z, &b->sums[z]);
        if (z == (size_t)(width / 2)) s->series[b->looks][0] = up;
        if (z == (size_t)width) s->series[b->looks][1] = up;
    }
    b->looks++;
}

// Fluxes of the mean flow at a height, around the axis: up to where it is a twentieth of that on
// it.
static void find_fluxes(const burner *b, int z, burner_level *l) {
    enum { MOST = PYRO_MOST_SIZE };
    static double up[MOST], count[MOST];
    const int nx = (int)b->desc->size[0], ny = (int)b->desc->size[1];
    memset(up, 0, sizeof up);
    memset(count, 0, sizeof count);
    for (int y = 0; y < ny; y++)
        for (int x = 0; x < nx; x++) {
            const double i = x + 0.5 - nx / 2.0, k = y + 0.5 - ny / 2.0;
            const int r = (int)sqrt(i * i + k * k);
            up[r] += b->cell_sums[SUMS * (size_t)(x + nx * (y + ny * z))] / (double)b->looks;
            count[r]++;
        }
    l->volume = l->momentum = 0;
    for (int r = 0; r < nx / 2 && up[r] / count[r] > 0.05 * l->w; r++) {
        l->volume += up[r] * pow(b->desc->cell, 2);
        l->momentum += up[r] * up[r] / count[r] * pow(b->desc->cell, 2);
    }
}

burner_seen burner_run(const theory_order *order, theory_check *c, const burner_desc *d) {
    burner b = {.desc = d};
    pyro_desc desc = {.faces = {[4] = PYRO_WALL}};
    memcpy(desc.size, d->size, sizeof desc.size);
    theory_open(order, c, &b.w, &desc, d->cell);
    const int between = (int)fmax(1, round(d->look / d->dt));
    const size_t looks = (size_t)(d->last / d->dt / between);
    burner_seen s = {.count = desc.size[2], .looks = looks, .step = between * d->dt};
    s.levels = arena_alloc(&c->memory, s.count * sizeof *s.levels);
    s.series = arena_alloc(&c->memory, looks * sizeof *s.series);
    b.sums = s.levels;
    memset(b.sums, 0, s.count * sizeof *b.sums);
    b.cell_sums = mem_alloc(SUMS * b.w.cells * sizeof *b.cell_sums);
    memset(b.cell_sums, 0, SUMS * b.w.cells * sizeof *b.cell_sums);
    pyro_numbers *n = &b.w.numbers;
    n->dt = (float)d->dt;
    n->ambient = 293;
    n->gravity = (float)gravity;
    n->ignition = 0; // what has mixed burns
    n->burn_time = 0;
    n->heat = (float)(d->heat * (1 - d->radiated));
    n->oxygen = (float)d->oxygen;
    n->molar_mass = (float)d->molar_mass;
    make_kernel(&b, order);
    steps(&b, c, (int)(d->settle / d->dt));
    while (b.looks < looks) {
        steps(&b, c, between);
        look(&b, &s);
    }
    for (size_t z = 0; z < s.count; z++) {
        burner_level *l = &s.levels[z];
        double *const means[] = {&l->w,    &l->warmth, &l->momentum_all,
                                 &l->lift, &l->heat,   &l->flame};
        for (size_t i = 0; i < COUNT_OF(means); i++) *means[i] /= (double)looks;
        find_fluxes(&b, (int)z, l);
    }
    gpu_test_ok(gpu_idle(b.w.device));
    kernel_destroy(&b.kernel, b.w.device);
    shader_library_destroy(b.library);
    mem_free(b.cell_sums);
    pyro_close(&b.w);
    return s;
}

theory_plot *burner_plot_heat(theory_check *c) {
    theory_plot *p = theory_add_plot(c, "Heat that passes, by what is given", "height, m", "share");
    theory_series *all = theory_add_series(c, p, "all", 2);
    p->log_y = all->expected = true;
    return p;
}

void burner_draw_heat(theory_check *c, theory_plot *p, const char *name, const burner_desc *d,
                      const burner_seen *s) {
    theory_series *line = theory_add_series(c, p, name, s->count), *all = &p->series[0];
    const double given = d->power * (1 - d->radiated);
    for (size_t z = 0; z < s->count; z++)
        theory_add(line, ((double)z + 0.5) * d->cell, s->levels[z].heat / given);
    if (all->count == 0) {
        theory_add(all, 0, 1);
        theory_add(all, (double)s->count * d->cell, 1);
    }
}
