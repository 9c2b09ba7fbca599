// Mode "paper" of the march against a twin in C of what document 0 (Raseta et al.) writes: rays and
// steps of section 3.5, the depth test of 3.6, the three noises of 3.7 blended into density (half)
// and temperature (30 %). The colour is added before the opacity, not after it as printed, which
// would darken every sample by itself.
//
// Tolerance: the picture is made of half floats (2^-11 of the value), and the host's noises differ
// from the device's by up to 1e-4, which N samples of weight o / N make 1e-4 * o / 2 = 0.001.
#include "pass_test.h"

enum { WIDTH = 24, HEIGHT = 16 };

typedef enum paper_noise { PERLIN, WORLEY, WORLEY_CURL, NOISE_COUNT } paper_noise;
static const char *const noise_names[] = {"perlin", "worley", "worley by curl"};

typedef struct paper_fields {
    const field *density, *color, *noise;
} paper_fields;

static const field *paper_worley(pass_world *w) {
    return row(w, "worley", SET("frequency", number(w, 3)), SET("power", number(w, 1.5f)),
               SET("drift", triple(w, 0.1f, 0.15f, 0.2f)), WORD("mode", "paper"));
}

static const field *make_noise(pass_world *w, paper_noise kind) {
    switch (kind) {
    case PERLIN:
        return row(w, "perlin", SET("frequency", number(w, 4)), SET("octaves", number(w, 2)),
                   SET("persistence", number(w, 0.5f)), SET("lacunarity", number(w, 2)),
                   SET("drift", triple(w, 0.1f, 0.15f, 0.2f)));
    case WORLEY:
        return paper_worley(w);
    default:
        return row(w, "warp", SET("value", paper_worley(w)),
                   SET("by", row(w, "curl", SET("step", number(w, 0.01f)),
                                 SET("frequency", number(w, 2)), WORD("mode", "paper"))),
                   SET("amount", number(w, 5)));
    }
}

static const field *blend(pass_world *w, const field *value, const field *noise, float share) {
    const field *product = row(w, "mul", SET("a", value), SET("b", noise));
    return row(w, "mix", SET("a", value), SET("b", product), SET("t", number(w, share)));
}

static const field *ball(pass_world *w, float falloff) {
    return row(w, "sphere", SET("radius", number(w, 1)), SET("falloff", number(w, falloff)));
}

static paper_fields make_fields(pass_world *w, paper_noise kind) {
    static const palette_stop stops[] = {
        {0, {0.02f, 0.02f, 0.02f, 0}}, {300, {1, 0.1f, 0, 0.5f}}, {1000, {3, 2, 0.5f, 1}}};
    const palette_key key = {0, stops, COUNT_OF(stops)};
    const palette *colors =
        palette_create(&w->memory, &(palette_desc){.keys = &key, .key_count = 1});
    gpu_test_ok(colors);
    const field *noise = make_noise(w, kind);
    const field *heat = row(w, "mul", SET("a", ball(w, 1)), SET("b", number(w, 1000)));
    const field *rgba = field_palette(&w->memory, colors, blend(w, heat, noise, 0.3f));
    gpu_test_ok(rgba);
    return (paper_fields){.density = blend(w, ball(w, 0.4f), noise, 0.5f),
                          .color = field_swizzle(&w->memory, rgba, "rgb"),
                          .noise = noise};
}

typedef struct ray {
    float origin[3], direction[3];
    float metres; // along the ray for each metre of depth
} ray;

static ray camera_ray(const struct frame_block *frame, uint32_t x, uint32_t y) {
    float u = ((float)x + 0.5f) / WIDTH, v = ((float)y + 0.5f) / HEIGHT, square = 0;
    float screen[3] = {(2 * u - 1) * frame->lens.v[0], (1 - 2 * v) * frame->lens.v[1], -1};
    ray r = {.metres = 0};
    for (int i = 0; i < 3; i++) {
        r.origin[i] = frame->eye.v[i];
        for (int k = 0; k < 3; k++) r.direction[i] += frame->view_inverse.m[4 * k + i] * screen[k];
        square += r.direction[i] * r.direction[i];
    }
    r.metres = sqrtf(square);
    for (int i = 0; i < 3; i++) r.direction[i] /= r.metres;
    return r;
}

static bool enter_box(const ray *r, box3 box, float range[2]) {
    const float low[3] = {box.min.x, box.min.y, box.min.z};
    const float high[3] = {box.max.x, box.max.y, box.max.z};
    range[0] = 0;
    range[1] = 1e30f;
    for (int i = 0; i < 3; i++) {
        float a = (low[i] - r->origin[i]) / r->direction[i];
        float b = (high[i] - r->origin[i]) / r->direction[i];
        range[0] = fmaxf(range[0], fminf(a, b));
        range[1] = fminf(range[1], fmaxf(a, b));
    }
    return range[0] < range[1];
}

typedef struct settings {
    int steps;
    float opacity;
    float wall, bias; // wall 0: none
} settings;

static void march_twin(const pass_world *w, const paper_fields *f, settings s, const ray *r,
                       float out[4]) {
    box3 box;
    float range[2];
    memset(out, 0, 4 * sizeof *out);
    gpu_test_ok(field_bounds(f->density, &w->context, &box));
    if (!enter_box(r, box, range)) return;
    float step = (range[1] - range[0]) / (float)s.steps;
    for (int i = 0; i < s.steps; i++) {
        float t = range[0] + (float)i * step;
        float3 p = {r->origin[0] + t * r->direction[0], r->origin[1] + t * r->direction[1],
                    r->origin[2] + t * r->direction[2]};
        float density[4], color[4];
        float visible = s.wall > 0 && t > s.wall * r->metres + s.bias ? 0 : 1;
        gpu_test_ok(field_eval(f->density, &w->context, p, density));
        gpu_test_ok(field_eval(f->color, &w->context, p, color));
        float part = fminf(density[0] * visible * s.opacity / (float)s.steps, 1);
        for (int c = 0; c < 3; c++) out[c] += (1 - out[3]) * color[c] * part;
        out[3] += (1 - out[3]) * part;
    }
}

static pass *add_march(pass_world *w, const paper_fields *f, settings s) {
    pass *p = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_option(p, "mode", "paper"));
    gpu_test_ok(pass_set_field(p, "density", f->density));
    gpu_test_ok(pass_set_field(p, "radiance", f->color));
    gpu_test_ok(pass_set_field(p, "noise", f->noise));
    gpu_test_ok(pass_set_uniform(p, "steps", number(w, (float)s.steps)));
    gpu_test_ok(pass_set_uniform(p, "opacity", number(w, s.opacity)));
    gpu_test_ok(pass_set_uniform(p, "depth_bias", number(w, s.bias)));
    if (s.wall > 0) {
        pass *wall = world_add(w, NULL, "wall.comp", "wall");
        gpu_test_ok(pass_set_uniform(wall, "distance_to", number(w, s.wall)));
        gpu_test_ok(pass_declare(wall));
        gpu_test_ok(pass_set_image(p, "depth", pass_output(wall, "depth")));
    }
    return p;
}

static void world_setup(pass_world *w, gpu *device) {
    world_open(w, device);
    w->scene.camera.eye = triple(w, 0.7f, -3, 0.9f);
    w->context.time = 0.7;
}

// Renders and compares every pixel; returns the mean opacity.
static double compare(gpu *device, paper_noise kind, settings s, float early_exit,
                      float tolerance) {
    pass_world w;
    world_setup(&w, device);
    paper_fields f = make_fields(&w, kind);
    pass *p = add_march(&w, &f, s);
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, early_exit)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    double sum = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        float want[4];
        ray r = camera_ray(&w.frame, i % WIDTH, i / WIDTH);
        march_twin(&w, &f, s, &r, want);
        sum += (double)want[3];
        for (uint32_t c = 0; c < 4; c++) {
            float got = pixels[4 * i + c];
            if (fabsf(got - want[c]) <= tolerance * fmaxf(1, want[c])) continue;
            fail_msg("%s, %d steps, wall %g: pixel (%u, %u) channel %u is %.6f, the twin's %.6f",
                     noise_names[kind], s.steps, (double)s.wall, i % WIDTH, i / WIDTH, c,
                     (double)got, (double)want[c]);
        }
    }
    mem_free(pixels);
    world_close(&w);
    return sum / (WIDTH * HEIGHT);
}

static void march_is_that_of_the_paper(void **state) {
    for (paper_noise kind = PERLIN; kind < NOISE_COUNT; kind++)
        for (int steps = 16; steps <= 64; steps *= 4) {
            double opacity = compare(*state, kind, (settings){steps, 20, 0, 0}, 0, 0.002f);
            assert_true(opacity > 0.1 && opacity < 0.9);
        }
}

static void samples_behind_the_scene_weigh_nothing_and_steps_stay(void **state) {
    for (paper_noise kind = PERLIN; kind < NOISE_COUNT; kind++)
        for (int steps = 16; steps <= 64; steps *= 4) {
            double open = compare(*state, kind, (settings){steps, 4, 0, 0}, 0, 0.002f);
            double cut = compare(*state, kind, (settings){steps, 4, 2.91f, 0.004f}, 0, 0.002f);
            assert_true(cut < 0.8 * open && cut > 0.2 * open);
        }
}

static void bias_is_metres_behind_the_scene(void **state) {
    double without = compare(*state, PERLIN, (settings){64, 4, 2.91f, 0}, 0, 0.002f);
    double with = compare(*state, PERLIN, (settings){64, 4, 2.91f, 0.3f}, 0, 0.002f);
    assert_true(with > 1.05 * without);
}

static void opacity_of_one_sample_ends_at_one(void **state) {
    compare(*state, PERLIN, (settings){16, 1000, 0, 0}, 0, 0.002f);
}

static void early_exit_loses_no_more_than_it_says(void **state) {
    compare(*state, PERLIN, (settings){64, 20, 0, 0}, 0.01f, 0.002f + 0.01f * 3);
}

static void noise_view_shows_the_noise_on_the_faces_of_the_box(void **state) {
    pass_world w;
    world_setup(&w, *state);
    paper_fields f = make_fields(&w, PERLIN);
    pass *p = add_march(&w, &f, (settings){16, 20, 0, 0});
    gpu_test_ok(pass_set_option(p, "view", "noise"));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    box3 box;
    size_t hits = 0;
    gpu_test_ok(field_bounds(f.density, &w.context, &box));
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        float range[2], want[4];
        ray r = camera_ray(&w.frame, i % WIDTH, i / WIDTH);
        const float *got = pixels + 4 * i;
        if (!enter_box(&r, box, range)) {
            assert_true(got[3] == 0);
            continue;
        }
        float3 front = {r.origin[0] + range[0] * r.direction[0],
                        r.origin[1] + range[0] * r.direction[1],
                        r.origin[2] + range[0] * r.direction[2]};
        gpu_test_ok(field_eval(f.noise, &w.context, front, want));
        assert_true(fabsf(got[0] - want[0]) < 0.001f && got[0] == got[2] && got[3] == 1);
        hits++;
    }
    assert_true(hits > WIDTH * HEIGHT / 10);
    mem_free(pixels);
    world_close(&w);
}

// ---- grids that are moved ---------------------------------------------------------------------

enum { TEXELS = 8 };

static bool update_nothing(field_grid *grid, gpu *g, double time) {
    (void)grid, (void)g, (void)time;
    return true;
}

// A cube of 2 m around the origin of which the half below x = 0 holds smoke, thicker towards +z;
// what is said to burn at the time lies within `active`.
static field_grid make_grid(gpu *device, box3 active) {
    static uint16_t texels[TEXELS * TEXELS * TEXELS][4];
    for (uint32_t i = 0; i < COUNT_OF(texels); i++) {
        const uint32_t x = i % TEXELS, y = i / TEXELS % TEXELS, z = i / (TEXELS * TEXELS);
        bool inside = x % 3 && x < 3 && y % (TEXELS - 1) && z % (TEXELS - 1);
        texels[i][0] = half_from_float(inside ? 0.4f + 0.08f * (float)z : 0);
    }
    field_grid grid = {.name = "cube",
                       .box = {{-1, -1, -1}, {1, 1, 1}},
                       .size = {TEXELS, TEXELS, TEXELS},
                       .channel_count = 1,
                       .state = {.active = active},
                       .update = update_nothing};
    gpu_image *made = gpu_image_create(device, &(gpu_image_desc){.label = "cube",
                                                                 .format = GPU_RGBA16F,
                                                                 .width = TEXELS,
                                                                 .height = TEXELS,
                                                                 .depth = TEXELS,
                                                                 .use = GPU_USE_SAMPLED});
    gpu_test_ok(made);
    gpu_test_ok(gpu_image_write(device, made, 0, texels, sizeof texels));
    grid.state.images[0][0] = made;
    return grid;
}

typedef struct moved {
    const char *mode;
    const char *by; // NULL, "transform", "warp"
    float3 place;   // where the cube is, and what the camera looks at
    box3 active;
} moved;

static const field *move(pass_world *w, const field *f, const moved *m) {
    if (!m->by) return f;
    const float3 at = m->place;
    if (strcmp(m->by, "transform") == 0)
        return row(w, "transform", SET("value", f), SET("translate", triple(w, at.x, at.y, at.z)));
    return row(w, "warp", SET("value", f), SET("by", triple(w, at.x, at.y, at.z)),
               SET("amount", number(w, -1)));
}

static float *march_grid(gpu *device, moved m) {
    pass_world w;
    world_open(&w, device);
    field_grid grid = make_grid(device, m.active);
    w.scene.camera.eye = triple(&w, m.place.x + 1, m.place.y - 4, m.place.z + 1);
    w.scene.camera.target = triple(&w, m.place.x, m.place.y, m.place.z);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_option(p, "mode", m.mode));
    gpu_test_ok(pass_set_option(p, "sampling", "linear"));
    gpu_test_ok(pass_set_uniform(p, "steps", number(&w, 512)));
    gpu_test_ok(pass_set_uniform(p, "opacity", number(&w, 2)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 1, 0.5f, 0.2f)));
    gpu_test_ok(
        pass_set_field(p, "density", move(&w, field_grid_channel(&w.memory, &grid, 0, 1), &m)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    world_close(&w);
    gpu_image_destroy(device, grid.state.images[0][0]);
    return pixels;
}

static const box3 whole_cube = {{-1, -1, -1}, {1, 1, 1}};

// The cube far from where its grid is, seen from as far away: the same picture. How far a warp
// reaches is known as a distance only: it makes the box wider, and so, as published, the smoke of
// mode paper thinner.
static void moved_grid_is_seen_whole_in_both_modes(void **state) {
    static const char *const modes[] = {"physical", "paper"}, *const ways[] = {"transform", "warp"};
    for (size_t i = 0; i < COUNT_OF(modes) * COUNT_OF(ways); i++) {
        moved m = {.mode = modes[i % 2], .active = whole_cube};
        float *still = march_grid(*state, m);
        m.by = ways[i / 2];
        m.place = (float3){1.5f, 0.5f, -1.25f};
        float *there = march_grid(*state, m);
        bool thinner = i % 2 == 1 && i / 2 == 1;
        size_t seen = 0;
        for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
            float a = still[4 * k + 3], b = there[4 * k + 3];
            if (a > 0.1f) seen++;
            if (thinner ? a > 0.1f && (b < 0.01f || b > a) : fabsf(a - b) > 0.02f)
                fail_msg("%s, %s: pixel (%zu, %zu) has opacity %g, unmoved %g", m.mode, m.by,
                         k % WIDTH, k / WIDTH, (double)b, (double)a);
        }
        assert_true(seen > 16);
        mem_free(still);
        mem_free(there);
    }
}

// Section 3.5: steps are parts of the whole box, whatever burns in it.
static void box_of_the_paper_is_that_of_the_data(void **state) {
    const box3 half = {{-1, -1, -1}, {0, 1, 1}};
    float *whole = march_grid(*state, (moved){.mode = "paper", .active = whole_cube});
    float *part = march_grid(*state, (moved){.mode = "paper", .active = half});
    assert_memory_equal(whole, part, sizeof(float[WIDTH * HEIGHT * 4]));
    mem_free(whole);
    mem_free(part);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(march_is_that_of_the_paper),
        cmocka_unit_test(samples_behind_the_scene_weigh_nothing_and_steps_stay),
        cmocka_unit_test(bias_is_metres_behind_the_scene),
        cmocka_unit_test(opacity_of_one_sample_ends_at_one),
        cmocka_unit_test(early_exit_loses_no_more_than_it_says),
        cmocka_unit_test(noise_view_shows_the_noise_on_the_faces_of_the_box),
        cmocka_unit_test(moved_grid_is_seen_whole_in_both_modes),
        cmocka_unit_test(box_of_the_paper_is_that_of_the_data),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
