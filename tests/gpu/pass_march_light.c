// How the march is lit, against what can be worked out on paper: a block 2 m wide around the
// origin, whose near face is 4 m away from the camera.
#include "field/palette.h"
#include "pass_test.h"

enum { SIZE = 17, CENTRE = (SIZE / 2) * SIZE + SIZE / 2 };
static const float PI = GLM_PIf;

static void near(double got, double wanted, double relative) {
    if (fabs(got - wanted) > relative * fabs(wanted) + 1e-6)
        fail_msg("%.6f, not %.6f (+- %g %%)", got, wanted, relative * 100);
}

static const field *four(pass_world *w, float x, float y, float z, float v) {
    return field_constant(&w->memory, 4, (float[4]){x, y, z, v});
}

// Density 1 is 1 / 2 / 4 a metre by colour, of which 0.8 / 0.5 / 0.2 scatter. No light yet.
static pass *coloured_block(pass_world *w, gpu *device, float density) {
    world_open(w, device);
    pass *p = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", block(w, 1, density)));
    gpu_test_ok(pass_set_uniform(p, "extinction", triple(w, 1, 2, 4)));
    gpu_test_ok(pass_set_uniform(p, "albedo", triple(w, 0.8f, 0.5f, 0.2f)));
    gpu_test_ok(pass_set_uniform(p, "anisotropy", number(w, 0)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(w, 0)));
    gpu_test_ok(pass_set_uniform(p, "ambient", number(w, 0)));
    return p;
}
static const double extinctions[3] = {1, 2, 4}, albedos[3] = {0.8, 0.5, 0.2};

static void overhead_sun(pass_world *w, float strength) {
    w->scene.sun.strength = number(w, strength);
    w->scene.sun.elevation = number(w, 90);
}

// The middle pixel; closes the world.
static void render_middle(pass_world *w, pass *p, float out[4]) {
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    float *pixels = world_read(w, pass_output(p, "color"));
    memcpy(out, pixels + CENTRE * 4, 4 * sizeof *out);
    mem_free(pixels);
    world_close(w);
}

// ---- the medium -------------------------------------------------------------------------------

static void coloured_extinction_follows_beer_and_lambert(void **state) {
    const float densities[] = {0.01f, 0.2f, 1.5f}, tolerances[] = {0, 0.01f};
    for (size_t i = 0; i < 2 * COUNT_OF(densities); i++) {
        pass_world w;
        float c[4], density = densities[i / 2];
        pass *p = coloured_block(&w, *state, density);
        gpu_test_ok(pass_set_field(p, "emission", triple(&w, 3, 3, 3)));
        gpu_test_ok(pass_set_uniform(p, "tolerance", number(&w, tolerances[i % 2])));
        render_middle(&w, p, c);
        double clear = 0;
        for (int k = 0; k < 3; k++) {
            double s = (double)density * extinctions[k];
            near(c[k], 3 * (1 - exp(-2 * s)) / s, 0.02);
            clear += exp(-2 * s) / 3;
        }
        near(c[3], 1 - clear, 0.02);
    }
}

static void absorption_color_lets_light_through(void **state) {
    pass_world w;
    float c[4];
    pass *p = coloured_block(&w, *state, 1);
    gpu_test_ok(pass_set_uniform(p, "extinction", triple(&w, 1, 1, 1)));
    gpu_test_ok(pass_set_uniform(p, "albedo", number(&w, 0)));
    gpu_test_ok(pass_set_uniform(p, "absorption_color", triple(&w, 1, 0.25f, 0)));
    render_middle(&w, p, c);
    near(c[3], 1 - (1 + exp(-1) + exp(-2)) / 3, 0.01); // 1 - sqrt(0.25) of the extinction is left
}

static void black_body_glows_as_hot_as_it_is(void **state) {
    pass_world w;
    float c[4], color[3];
    pass *p = coloured_block(&w, *state, 0.5f);
    gpu_test_ok(pass_set_field(p, "temperature", number(&w, 1800)));
    gpu_test_ok(pass_set_field(p, "blackbody_intensity", number(&w, 2e3f)));
    gpu_test_ok(pass_set_uniform(p, "blackbody_tint", triple(&w, 1, 0.5f, 1)));
    render_middle(&w, p, c);
    palette_blackbody(1800, color);
    double megawatts = 5.670373e-14 * pow(1800, 4) / (double)PI;
    for (int k = 0; k < 3; k++) {
        double held = (1 - exp(-extinctions[k])) / (0.5 * extinctions[k]);
        near(c[k], 2e3 * megawatts * (k == 1 ? 0.5 : 1) * (double)color[k] * held, 0.02);
    }
}

// ---- light ------------------------------------------------------------------------------------

// Every point that the middle ray meets lies 1 m below the face that the sun stands over.
static double scattered_once(int channel, double depth_factor) {
    double s = extinctions[channel];
    return 5 * albedos[channel] / (4 * (double)PI) * exp(-s * depth_factor) * (1 - exp(-2 * s));
}

static void sun_is_scattered_once(void **state) {
    const float tolerances[] = {0, 0.01f};
    for (size_t i = 0; i < COUNT_OF(tolerances); i++) {
        pass_world w;
        float c[4];
        pass *p = coloured_block(&w, *state, 1);
        overhead_sun(&w, 5);
        gpu_test_ok(pass_set_uniform(p, "tolerance", number(&w, tolerances[i])));
        render_middle(&w, p, c);
        for (int k = 0; k < 3; k++) near(c[k], scattered_once(k, 1), 0.02);
    }
}

static void tint_is_a_factor_of_what_is_scattered(void **state) {
    pass_world w;
    float c[4];
    pass *p = coloured_block(&w, *state, 1);
    overhead_sun(&w, 5);
    gpu_test_ok(pass_set_field(p, "tint", triple(&w, 1, 0.5f, 0)));
    render_middle(&w, p, c);
    near(c[0], scattered_once(0, 1), 0.02);
    near(c[1], 0.5 * scattered_once(1, 1), 0.02);
    near(c[2], 0, 0);
}

static double hg(double cosine, double g) {
    return (1 - g * g) / (4 * (double)PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

static void each_lobe_spreads_light_by_its_weight(void **state) {
    pass_world w;
    float c[4];
    pass *p = coloured_block(&w, *state, 1);
    overhead_sun(&w, 5);
    gpu_test_ok(pass_set_uniform(p, "lobe_weights", four(&w, 3, 0, 1, 0)));
    gpu_test_ok(pass_set_uniform(p, "lobe_anisotropies", four(&w, 0.6f, 0.9f, -0.4f, 0)));
    render_middle(&w, p, c);
    double blend = (0.75 * hg(0, 0.6) + 0.25 * hg(0, -0.4)) * 4 * (double)PI;
    near(c[0], blend * scattered_once(0, 1), 0.02);
}

// Light that goes on the way it came is strong where g is above 0: the sun behind the block.
static void scattering_is_forward_above_zero(void **state) {
    float c[2][4];
    for (int i = 0; i < 2; i++) {
        pass_world w;
        pass *p = coloured_block(&w, *state, 0.1f);
        overhead_sun(&w, 5);
        w.scene.sun.elevation = number(&w, 0);
        w.scene.sun.azimuth = number(&w, 90);
        gpu_test_ok(pass_set_uniform(p, "anisotropy", number(&w, i ? -0.6f : 0.6f)));
        render_middle(&w, p, c[i]);
    }
    near(c[0][0] / c[1][0], hg(1, 0.6) / hg(-1, 0.6), 0.02);
}

static void point_light_falls_off_and_is_shadowed(void **state) {
    pass_world w;
    float c[4];
    pass *p = coloured_block(&w, *state, 1);
    scene_light lamp = {.kind = SCENE_POINT,
                        .position = triple(&w, 0, 0, 3),
                        .color = triple(&w, 1, 1, 1),
                        .power = number(&w, 100),
                        .radius = number(&w, 0)};
    w.scene.lights = &lamp;
    w.scene.light_count = 1;
    render_middle(&w, p, c);
    for (int k = 0; k < 3; k++) {
        double sum = 0, s = extinctions[k];
        const int count = 2000;
        for (int i = 0; i < count; i++) {
            double y = -1 + 2 * (i + 0.5) / count, square = y * y + 9;
            double inside = sqrt(square) / 3; // 1 m of the 3 m down is in the block
            double irradiance = 100 / (4 * (double)PI) / square;
            sum += irradiance * exp(-s * (inside + y + 1)) * 2 / count;
        }
        near(c[k], sum * s * albedos[k] / (4 * (double)PI), 0.02);
    }
}

static void octaves_are_a_sum_of_dimmer_and_farther_light(void **state) {
    const float counts[] = {1, 3};
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        pass_world w;
        float c[4];
        pass *p = coloured_block(&w, *state, 1);
        overhead_sun(&w, 5);
        gpu_test_ok(pass_set_option(p, "scattering", "octaves"));
        gpu_test_ok(pass_set_uniform(p, "octaves", number(&w, counts[i])));
        gpu_test_ok(pass_set_uniform(p, "octave_contribution", number(&w, 0.4f)));
        render_middle(&w, p, c);
        for (int k = 0; k < 3; k++) {
            double wanted = scattered_once(k, 1);
            if (counts[i] > 1)
                wanted += 0.4 * scattered_once(k, 0.5) + 0.16 * scattered_once(k, 0.25);
            near(c[k], wanted, 0.02);
        }
    }
}

static void powder_darkens_what_is_thin(void **state) {
    pass_world w;
    float c[4];
    pass *p = coloured_block(&w, *state, 1);
    overhead_sun(&w, 5);
    gpu_test_ok(pass_set_uniform(p, "powder", number(&w, 0.5f)));
    render_middle(&w, p, c);
    for (int k = 0; k < 3; k++)
        near(c[k], scattered_once(k, 1) * (1 - 0.5 * exp(-2 * extinctions[k])), 0.02);
}

static void mesh_shadows_hide_the_sun(void **state) {
    const char *const words[] = {"off", "on"};
    for (int i = 0; i < 2; i++) {
        pass_world w;
        float c[4];
        pass *p = coloured_block(&w, *state, 1);
        overhead_sun(&w, 5);
        scene_mesh *roof = world_mesh(&w, "plane.obj");
        roof->position = triple(&w, 0, 0, 2);
        roof->rotation = triple(&w, 90, 0, 0);
        roof->scale = number(&w, 100);
        gpu_test_ok(pass_set_option(p, "mesh_shadows", words[i]));
        render_middle(&w, p, c);
        near(c[0], i ? 0 : scattered_once(0, 1), 0.02);
    }
}

// The lights that stand for the fire have lost what the smoke takes on the way out: a march takes
// nothing more of it, whether others are shadowed by the cache or by itself.
static void smoke_takes_nothing_twice_of_its_fire(void **state) {
    float c[2][4];
    for (int i = 0; i < 2; i++) {
        pass_world w;
        pass *p = coloured_block(&w, *state, 1);
        pass *lit = world_add(&w, "lighting", NULL, "lighting");
        gpu_test_ok(pass_set_field(lit, "density", block(&w, 1, 1)));
        gpu_test_ok(pass_set_field(lit, "emission", triple(&w, 3, 2, 1)));
        gpu_test_ok(pass_declare(lit));
        gpu_test_ok(pass_set_image(p, "lights", pass_output(lit, "lights")));
        if (i) gpu_test_ok(pass_set_image(p, "shadow", pass_output(lit, "shadow")));
        render_middle(&w, p, c[i]);
        assert_true(c[i][2] > 0.01f);
    }
    for (int k = 0; k < 3; k++) near(c[0][k], c[1][k], 0.01);
}

// ---- functions --------------------------------------------------------------------------------

typedef float texel[4];

// A row of `light_functions.comp`.
static void function_row(gpu *device, float first, float last, int row, texel out[SIZE]) {
    pass_world w;
    world_open(&w, device);
    pass *p = world_add(&w, NULL, "light_functions.comp", "functions");
    gpu_test_ok(pass_set_field(p, "density", number(&w, 1)));
    gpu_test_ok(pass_set_uniform(p, "first", number(&w, first)));
    gpu_test_ok(pass_set_uniform(p, "last", number(&w, last)));
    gpu_test_ok(pass_set_uniform(p, "lobe_weights", four(&w, 1, 2, 3, 4)));
    gpu_test_ok(pass_set_uniform(p, "lobe_anisotropies", four(&w, 0.9f, 0.5f, 0, -0.7f)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, 3, pass_output(p, "color"));
    texel all[3 * SIZE];
    gpu_image *image = graph_get_image(w.host.graph, pass_output(p, "color"));
    gpu_test_ok(gpu_image_read(device, image, all, sizeof all));
    memcpy(out, all + row * SIZE, SIZE * sizeof *out);
    world_close(&w);
}

static void phase_functions_integrate_to_one(void **state) {
    texel row[SIZE];
    function_row(*state, -0.9f, 0.9f, 0, row);
    for (int i = 0; i < SIZE; i++) {
        near(row[i][0], 1, 0.001);
        near(row[i][1], 1, 0.001);
    }
}

static void blended_lobes_integrate_to_one_around_their_mean(void **state) {
    texel row[SIZE];
    function_row(*state, 0, 0, 1, row);
    near(row[0][0], 1, 0.001);
    near(row[0][1], 0.1 * 0.9 + 0.2 * 0.5 - 0.4 * 0.7, 0.01);
    near(row[0][1], row[0][2], 0.01);
}

static void black_body_has_the_colour_of_palettes(void **state) {
    const float ranges[][2] = {{800, 2000}, {2000, 12000}};
    for (size_t r = 0; r < COUNT_OF(ranges); r++) {
        texel row[SIZE];
        function_row(*state, ranges[r][0], ranges[r][1], 2, row);
        for (int i = 0; i < SIZE; i++) {
            float wanted[3];
            double kelvin =
                (double)(ranges[r][0] + (ranges[r][1] - ranges[r][0]) * (float)i / (SIZE - 1));
            double megawatts = 5.670373e-14 * pow(kelvin, 4) / (double)PI;
            palette_blackbody((float)kelvin, wanted);
            for (int k = 0; k < 3; k++)
                assert_true(fabs((double)row[i][k] / megawatts - (double)wanted[k]) < 0.0016);
        }
    }
}

static void black_body_below_800_kelvin_fades_in_one_colour(void **state) {
    texel row[SIZE];
    function_row(*state, 0, 800, 2, row);
    near(row[0][0], 0, 0);
    near(row[SIZE / 2][0], row[SIZE - 1][0] / 16, 0.001);
    assert_true(row[SIZE / 2][1] == 0 && row[SIZE / 2][2] == 0);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(coloured_extinction_follows_beer_and_lambert),
        cmocka_unit_test(absorption_color_lets_light_through),
        cmocka_unit_test(black_body_glows_as_hot_as_it_is),
        cmocka_unit_test(sun_is_scattered_once),
        cmocka_unit_test(tint_is_a_factor_of_what_is_scattered),
        cmocka_unit_test(each_lobe_spreads_light_by_its_weight),
        cmocka_unit_test(scattering_is_forward_above_zero),
        cmocka_unit_test(point_light_falls_off_and_is_shadowed),
        cmocka_unit_test(octaves_are_a_sum_of_dimmer_and_farther_light),
        cmocka_unit_test(powder_darkens_what_is_thin),
        cmocka_unit_test(mesh_shadows_hide_the_sun),
        cmocka_unit_test(smoke_takes_nothing_twice_of_its_fire),
        cmocka_unit_test(phase_functions_integrate_to_one),
        cmocka_unit_test(blended_lobes_integrate_to_one_around_their_mean),
        cmocka_unit_test(black_body_has_the_colour_of_palettes),
        cmocka_unit_test(black_body_below_800_kelvin_fades_in_one_colour),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
