// Simulated air with templates, of either kind: passes `lbm` and `pyro` without an effect, their
// groups, steps, and what then lies on the device. Boxes are 32 cells of 0.1 m a side, from z = 0.
#pragma once
#include "library_test.h"
#include "pass/air/lbm_parts.h"
#include "pass/air/pyro_parts.h"
#include "pass_test.h"

enum { AIR_SIDE = 32, AIR_CELLS = AIR_SIDE * AIR_SIDE * AIR_SIDE, AIR_ROWS = 7 };

typedef struct air_world {
    pass_world w;
    pass *pass;
    pass *groups[8];
    uint32_t group_count, total;
    double time;
} air_world;

typedef struct air_seen {       // a template on the device
    float middle[3], half_side; // texels
    float right[3], factor;
    float up[3], look;
    float age, lifetime, life, side;
    float put[3], is_put; // cells
    float put_right[4], put_up[4];
} air_seen;

static inline void air_test_open(air_world *t, gpu *device, const char *type, const char *faces) {
    *t = (air_world){0};
    world_open(&t->w, device);
    t->pass = world_add(&t->w, type, NULL, "air");
    static const char *const sides[] = {"left", "right", "front", "back", "bottom", "top"};
    for (int i = 0; i < 6; i++) {
        char name[32];
        snprintf(name, sizeof name, "boundary_%s", sides[i]);
        gpu_test_ok(pass_set_option(t->pass, name, faces));
    }
    gpu_test_ok(pass_set_option(t->pass, "precision", "f32"));
}

// After options of the pass.
static inline void air_test_declare(air_world *t) {
    const pass_air_desc desc = {.size = {AIR_SIDE, AIR_SIDE, AIR_SIDE},
                                .voxel_size = 0.1,
                                .speed = 4,
                                .time_step = strcmp(t->pass->type->name, "pyro") == 0 ? 0.02 : 0,
                                .time_scale = 1};
    gpu_test_ok(strcmp(t->pass->type->name, "pyro") == 0 ? pass_pyro_open(t->pass, &desc)
                                                         : pass_lbm_open(t->pass, &desc));
    gpu_test_ok(pass_declare(t->pass));
}

static inline void air_test_set(air_world *t, pass *p, const char *name, float value) {
    gpu_test_ok(pass_set_uniform(p, name, number(&t->w, value)));
}

static inline void air_test_word(pass *p, const char *name, const char *word) {
    gpu_test_ok(pass_set_option(p, name, word));
}

// A group that is not yet the air's.
static inline pass *air_test_group(air_world *t) {
    char type[32], label[32];
    snprintf(type, sizeof type, "%s_templates", t->pass->type->name);
    snprintf(label, sizeof label, "templates%u", t->group_count);
    pass *p = world_add(&t->w, type, NULL, label);
    t->groups[t->group_count++] = p;
    return p;
}

// Now it is; after options and fields.
static inline void air_test_add(air_world *t, pass *p, const picture *image, uint32_t count) {
    gpu_test_ok(pass_declare(p));
    gpu_test_ok(pass_air_add_templates(t->pass, p, image, count));
    t->total += count;
}

static inline const field *air_test_ball(air_world *t, float x, float y, float z, float radius) {
    return row(&t->w, "sphere", SET("position", triple(&t->w, x, y, z)),
               SET("radius", number(&t->w, radius)), SET("falloff", number(&t->w, 0)));
}

// One in the middle, upright, of `side` m, which stays.
static inline pass *air_test_middle(air_world *t, const picture *image, const char *kind,
                                    const char *depth, float side, float strength) {
    pass *p = air_test_group(t);
    gpu_test_ok(pass_set_field(p, "region", air_test_ball(t, 0, 0, 1.6f, 1e-4f)));
    air_test_word(p, "align", "fixed");
    air_test_word(p, "kind", kind);
    air_test_word(p, "depth", depth);
    air_test_set(t, p, "size_min", side);
    air_test_set(t, p, "size_max", side);
    air_test_set(t, p, "strength", strength);
    air_test_set(t, p, "fade", 0);
    air_test_set(t, p, "lifetime_min", 1000);
    air_test_set(t, p, "lifetime_max", 1000);
    air_test_add(t, p, image, 1);
    return p;
}

static inline void air_test_build(air_world *t) {
    gpu_test_ok(pass_complete(t->pass) && pass_build(t->pass) && pass_allocate(t->pass));
    for (size_t i = 0; i < t->w.count; i++)
        if (t->w.passes[i] != t->pass) gpu_test_ok(pass_allocate(t->w.passes[i]));
}

// So many steps more; at first at least two.
static inline void air_test_run(air_world *t, int steps) {
    const air *a = air_of(t->pass);
    const uint64_t aim = (a->fresh ? 0 : a->kind->steps(a)) + (uint64_t)steps;
    // The state is a step ahead of the time for some kinds: half a step decides.
    while (a->fresh || a->kind->steps(a) < aim) {
        const int64_t left = (int64_t)(aim - (a->fresh ? 0 : a->kind->steps(a)));
        t->w.context.time = air_step_time(a, aim - (left > 16 ? (uint64_t)left - 16 : 0));
        if (a->kind->late) t->w.context.time -= air_step_seconds(a);
        t->w.context.time -= 0.5 * air_step_seconds(a);
        gpu_test_ok(gpu_frame_begin(t->w.host.device));
        gpu_test_ok(air_advance(t->pass));
        gpu_test_ok(gpu_frame_end(t->w.host.device));
    }
    assert_true(a->kind->steps(a) == aim || a->kind->steps(a) == 2);
}

// All of them; free with mem_free.
static inline air_seen *air_test_read(air_world *t) {
    gpu_buffer *buffer = air_of(t->pass)->templates.set.instances;
    const size_t size = (size_t)gpu_buffer_size(buffer);
    float *values = mem_alloc(size);
    gpu_test_ok(gpu_buffer_read(t->w.host.device, buffer, 0, values, size));
    air_seen *out = mem_alloc(t->total * sizeof *out);
    assert_int_equal(size, t->total * sizeof *out);
    for (uint32_t i = 0; i < t->total; i++)
        for (uint32_t r = 0; r < AIR_ROWS; r++)
            memcpy((float *)&out[i] + 4 * r, values + 4 * (r * t->total + i), 16);
    mem_free(values);
    return out;
}

static inline float *air_test_halves(gpu *device, gpu_image *image, size_t *count) {
    const gpu_image_desc *d = gpu_image_get_desc(image);
    *count = 4 * (size_t)d->width * d->height * d->depth;
    uint16_t *halves = mem_alloc(*count * 2);
    gpu_test_ok(gpu_image_read(device, image, halves, *count * 2));
    float *out = mem_alloc(*count * sizeof *out);
    for (size_t i = 0; i < *count; i++) out[i] = half_to_float(halves[i]);
    mem_free(halves);
    return out;
}

enum { AIR_TEXELS = AIR_SIDE / AIR_COARSER };

// The image that the solver reads: 16^3 texels of force and outflow; free with mem_free.
static inline float (*air_test_image(air_world *t))[4] {
    size_t count;
    float *out = air_test_halves(t->w.host.device, air_of(t->pass)->templates.image, &count);
    assert_int_equal(count, 4 * AIR_TEXELS * AIR_TEXELS * AIR_TEXELS);
    return (float(*)[4])out;
}

typedef struct air_flow { // in the middle of cells, x fastest
    float (*v)[4];        // m/s; density by that at rest
    int side;             // cells
    double cell;          // m
} air_flow;

// Free v with mem_free.
static inline air_flow air_test_flow(air_world *t) {
    gpu *device = t->w.host.device;
    gpu_test_ok(gpu_idle(device));
    if (strcmp(t->pass->type->name, "pyro") == 0) {
        const pyro_air *p = pyro_air_of(t->pass);
        gpu_image *image = pyro_image(p->solver, PYRO_FLOW, 0);
        size_t count;
        air_flow f = {(float(*)[4])air_test_halves(device, image, &count),
                      (int)gpu_image_get_desc(image)->width, 0};
        f.cell = 0.1 * AIR_SIDE / f.side;
        for (size_t i = 3; i < count; i += 4) (&f.v[0][0])[i] = 1;
        return f;
    }
    const lbm_air *l = lbm_air_of(t->pass);
    gpu_buffer *buffer = lbm_moments(l->solver, 0);
    const float speed = (float)(l->air.units.cell / l->air.units.step);
    uint16_t *halves = mem_alloc(16 * (size_t)AIR_CELLS);
    gpu_test_ok(gpu_buffer_read(device, buffer, 0, halves, 16 * (size_t)AIR_CELLS));
    air_flow f = {mem_alloc(AIR_CELLS * sizeof *f.v), AIR_SIDE, 0.1};
    for (size_t i = 0; i < AIR_CELLS; i++)
        for (int k = 0; k < 4; k++) {
            const float v = half_to_float(halves[8 * i + (size_t)k]);
            f.v[i][k] = k < 3 ? speed * v : 1 + v;
        }
    mem_free(halves);
    return f;
}

// Out of a cube of cells that is so many from the box's faces, m^3/s.
static inline double air_test_flux(const air_flow *f, int margin) {
    const int high = f->side - margin;
    double sum = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int i = margin; i < high; i++)
            for (int k = margin; k < high; k++)
                for (int end = 0; end < 2; end++)
                    for (int side = -1; side <= 0; side++) {
                        int c[3];
                        c[(axis + 1) % 3] = i, c[(axis + 2) % 3] = k;
                        c[axis] = (end ? high : margin) + side;
                        const float *v = f->v[c[0] + f->side * (c[1] + f->side * c[2])];
                        sum += (end ? 0.5 : -0.5) * (double)v[axis] * (double)v[3];
                    }
    return sum * f->cell * f->cell;
}

// The integral of a channel of a picture that is made deep, for a side of 2.
static inline double air_test_integral(const picture *image, int channel, bool extruded) {
    static float tile[TEMPLATE_TILE_VALUES];
    const double step = 2.0 / TEMPLATE_TILE;
    double sum = 0, deep = 0;
    template_tile(image, tile);
    for (int y = 0; y < TEMPLATE_TILE; y++)
        for (int x = 0; x < TEMPLATE_TILE; x++) {
            const double at = fabs((x + 0.5) * step - 1);
            const double value = (double)tile[4 * (y * TEMPLATE_TILE + x) + channel];
            sum += value * step * step * (extruded ? 1 : acos(-1) * at);
        }
    for (int i = 0; i < 200; i++) deep += 0.01 * exp(-0.5 * pow((0.01 * (i + 0.5) - 1) / 0.3, 2));
    return extruded ? sum * deep : sum;
}
