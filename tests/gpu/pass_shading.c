// lib/shading.glsl: what a surface sends back, against the published formulas and against what
// arrived.
#include "pass_test.h"

typedef struct surface {
    float specular, roughness, metallic, toon;
} surface;

// Pixels of shading_probe.comp; free with mem_free.
static float *probe(gpu *device, const char *show, const char *model, surface s, float levels,
                    uint32_t width, uint32_t height) {
    pass_world w;
    world_open(&w, device);
    pass *p = world_add(&w, NULL, "shading_probe.comp", "probe");
    const struct {
        const char *name;
        float value;
    } numbers[] = {{"specular", s.specular},
                   {"roughness", s.roughness},
                   {"metallic", s.metallic},
                   {"toon", s.toon},
                   {"toon_levels", levels}};
    gpu_test_ok(pass_set_option(p, "show", show) && pass_set_option(p, "model", model));
    for (size_t i = 0; i < COUNT_OF(numbers); i++)
        gpu_test_ok(pass_set_uniform(p, numbers[i].name, number(&w, numbers[i].value)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, width, height, pass_output(p, "color"));
    gpu_image *image = graph_get_image(w.host.graph, pass_output(p, "color"));
    float *out = mem_alloc(16ull * width * height);
    gpu_test_ok(gpu_image_read(device, image, out, 16ull * width * height));
    world_close(&w);
    return out;
}

// ---- energy -------------------------------------------------------------------------------------

static void a_physical_surface_sends_back_no_more_than_arrives(void **state) {
    enum { VIEWS = 24, ROUGH = 16 };
    static const surface surfaces[] = {{.specular = 0.5f},
                                       {.specular = 1},
                                       {.specular = 0.1f},
                                       {.metallic = 1},
                                       {.specular = 0.5f, .metallic = 0.5f}};
    for (size_t i = 0; i < COUNT_OF(surfaces); i++) {
        float *c = probe(*state, "furnace", "physical", surfaces[i], 4, VIEWS, ROUGH);
        float least = 2, most = 0, mirrored = 0;
        for (size_t k = 0; k < VIEWS * ROUGH; k++) {
            least = fminf(least, c[4 * k]);
            most = fmaxf(most, c[4 * k]);
            mirrored = fmaxf(mirrored, c[4 * k + 1]);
        }
        if (!(most < 1.006f && least > 0.25f && mirrored > 0.02f))
            fail_msg("surface %zu: %.4f to %.4f of the light, up to %.4f mirrored", i,
                     (double)least, (double)most, (double)mirrored);
        mem_free(c);
    }
}

static void a_matte_surface_sends_back_its_colour(void **state) {
    enum { VIEWS = 8, ROUGH = 4 };
    float *c = probe(*state, "furnace", "physical", (surface){0}, 4, VIEWS, ROUGH);
    for (size_t k = 0; k < VIEWS * ROUGH; k++)
        assert_true(c[4 * k] == 1 && c[4 * k + 1] == 0 && c[4 * k + 2] == 1);
    mem_free(c);
}

// ---- formulas -----------------------------------------------------------------------------------

enum { ANGLES = 512 };

// Cosines of the light at a pixel, to the normal and to half way to the view.
static void cosines(size_t i, double *to_normal, double *to_middle) {
    double a = GLM_PI * ((double)(i % ANGLES + 0.5) / ANGLES - 0.5),
           v = i < ANGLES ? 0 : GLM_PI / 4;
    *to_normal = cos(a);
    *to_middle = cos((a + v) / 2);
}

static void expect(float got, double want, const char *what, size_t i) {
    if (!(fabs((double)got - want) <= 1e-4 + 1e-3 * want))
        fail_msg("%s, angle %zu: %.5f, not %.5f", what, i, (double)got, want);
}

static void models_are_their_formulas(void **state) {
    const surface s = {.specular = 0.4f, .roughness = 0.5f};
    float *lambert = probe(*state, "light", "lambert", s, 4, ANGLES, 2);
    float *blinn = probe(*state, "light", "blinn_phong", s, 4, ANGLES, 2);
    for (size_t i = 0; i < 2 * ANGLES; i++) {
        double n, h, exponent = 2 / 0.0625 - 2; // of a facet's slope of roughness squared
        cosines(i, &n, &h);
        expect(lambert[4 * i], n, "lambert", i);
        expect(blinn[4 * i], n + 0.4 * pow(h, exponent), "blinn_phong", i);
    }
    mem_free(lambert);
    mem_free(blinn);
}

static double band(double share, int levels) {
    return (fmin(floor(share * levels), levels - 1) + 0.5) / levels;
}

// As published: the middle of each band, of what is diffuse and of what is specular.
static void toon_shading_has_so_many_bands(void **state) {
    for (int levels = 1; levels <= 5; levels += 2) {
        const surface shiny = {.specular = 0.4f, .roughness = 0.5f, .toon = 1}, matte = {.toon = 1};
        float *c = probe(*state, "light", "toon", matte, (float)levels, ANGLES, 2);
        float *d = probe(*state, "light", "toon", shiny, (float)levels, ANGLES, 2);
        int changes = 0, wrong = 0;
        for (size_t i = 0; i < 2 * ANGLES; i++) {
            double n, h;
            cosines(i, &n, &h);
            double want = band(n, levels);
            wrong += fabs((double)c[4 * i] - want) > 1e-5;
            want += 0.4 * band(pow(h, 30), levels);
            wrong += fabs((double)d[4 * i] - want) > 1e-5;
            changes += i % ANGLES > 0 && c[4 * i] != c[4 * i - 4];
        }
        assert_int_equal(changes, 2 * 2 * (levels - 1)); // up and down, in two rows
        if (wrong > 4) fail_msg("%d levels: %d values are not those of a band", levels, wrong);
        mem_free(c);
        mem_free(d);
    }
}

static void toon_shading_can_be_refused(void **state) {
    const surface s = {.specular = 0.5f, .roughness = 0.4f};
    float *refused = probe(*state, "light", "toon", s, 3, ANGLES, 2);
    float *physical = probe(*state, "light", "physical", s, 3, ANGLES, 2);
    assert_memory_equal(refused, physical, 16 * 2 * ANGLES);
    mem_free(refused);
    mem_free(physical);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_physical_surface_sends_back_no_more_than_arrives),
        cmocka_unit_test(a_matte_surface_sends_back_its_colour),
        cmocka_unit_test(models_are_their_formulas),
        cmocka_unit_test(toon_shading_has_so_many_bands),
        cmocka_unit_test(toon_shading_can_be_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
