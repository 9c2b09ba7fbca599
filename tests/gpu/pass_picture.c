// Passes on pictures: the bright pass, the bloom, laying over, a user's own shaders.
#include "pass_test.h"

static double sum(const float *pixels, size_t count, int channel) {
    double total = 0;
    for (size_t i = 0; i < count; i++) total += (double)pixels[i * 4 + (size_t)channel];
    return total;
}

static pass *add_dot(pass_world *w) {
    pass *dot = world_add(w, NULL, "dot.comp", "dot");
    gpu_test_ok(pass_declare(dot));
    return dot;
}

static void bright_keeps_only_what_is_above_the_threshold(void **state) {
    const char *const modes[] = {"soft", "paper"};
    for (int mode = 0; mode < 2; mode++) {
        pass_world w;
        world_open(&w, *state);
        pass *dot = add_dot(&w), *bright = world_add(&w, "bright", NULL, "bright");
        gpu_test_ok(pass_set_option(bright, "mode", modes[mode]));
        gpu_test_ok(pass_set_image(bright, "source", pass_output(dot, "color")));
        gpu_test_ok(pass_declare(bright));
        world_render(&w, 32, 32, pass_output(bright, "color"));
        float *c = world_read(&w, pass_output(bright, "color"));
        double luminance = 0.2126 * 8 + 0.7152 * 4 + 0.0722 * 2;
        double wanted = mode == 0 ? 8 * (luminance - 1) / luminance : 8;
        assert_true(c[0] == 0); // the dim ground
        assert_true(fabs((double)c[(16 * 32 + 16) * 4] - wanted) < 0.01);
        mem_free(c);
        world_close(&w);
    }
}

// Total light of the bloom over that of its input.
static double bloom_gain(gpu *device, const char *mode, float radius, uint32_t width,
                         uint32_t height) {
    pass_world w;
    world_open(&w, device);
    pass *dot = add_dot(&w), *bloom = world_add(&w, "bloom", NULL, "bloom");
    gpu_test_ok(pass_set_option(bloom, "mode", mode));
    gpu_test_ok(pass_set_uniform(bloom, "radius", number(&w, radius)));
    gpu_test_ok(pass_set_image(bloom, "source", pass_output(dot, "color")));
    gpu_test_ok(pass_declare(bloom));
    graph_add_output(w.host.graph, pass_output(dot, "color"));
    world_render(&w, width, height, pass_output(bloom, "color"));
    float *before = world_read(&w, pass_output(dot, "color"));
    float *after = world_read(&w, pass_output(bloom, "color"));
    double gain = sum(after, (size_t)width * height, 0) / sum(before, (size_t)width * height, 0);
    mem_free(before);
    mem_free(after);
    world_close(&w);
    return gain;
}

static void bloom_has_the_energy_of_its_input(void **state) {
    const float radii[] = {0, 0.3f, 0.7f, 1};
    for (size_t i = 0; i < COUNT_OF(radii); i++) {
        double even = bloom_gain(*state, "normal", radii[i], 128, 64);
        double odd = bloom_gain(*state, "normal", radii[i], 117, 61);
        if (fabs(even - 1) > 0.01) fail_msg("radius %g: gain %g", (double)radii[i], even);
        if (fabs(odd - 1) > 0.03) fail_msg("odd size, radius %g: gain %g", (double)radii[i], odd);
    }
}

static void paper_bloom_adds_energy_with_every_level(void **state) {
    // C_i += 0.8 U(C_{i+1}) over M = ceil(log2 128) = 7 halvings: 1 + 0.8 + ... + 0.8^7.
    double wanted = (1 - pow(0.8, 8)) / (1 - 0.8);
    double gain = bloom_gain(*state, "paper", 0.5f, 128, 128);
    if (fabs(gain - wanted) > 0.03 * wanted) fail_msg("gain %g, not %g", gain, wanted);
}

// What the bloom of a bright picture is like. A bright picture of another format than the bloom's
// is always made; another one the bloom does without.
static float *bright_bloom(gpu *device, gpu_format format, const char *mode, size_t *passes) {
    pass_world w;
    world_open(&w, device);
    pass *dot = add_dot(&w), *bright = world_add(&w, "bright", NULL, "bright");
    pass *bloom = world_add(&w, "bloom", NULL, "bloom");
    gpu_test_ok(pass_set_option(bright, "mode", mode) && pass_set_option(bloom, "mode", "normal"));
    gpu_test_ok(pass_set_uniform(bright, "threshold", number(&w, 0.3f)));
    gpu_test_ok(pass_set_format(bright, "color", format));
    gpu_test_ok(pass_set_image(bright, "source", pass_output(dot, "color")));
    gpu_test_ok(pass_declare(bright));
    gpu_test_ok(pass_set_image(bloom, "source", pass_output(bright, "color")));
    gpu_test_ok(pass_declare(bloom));
    world_render(&w, 117, 61, pass_output(bloom, "color"));
    *passes = graph_order(w.host.graph, NULL, 0);
    float *c = world_read(&w, pass_output(bloom, "color"));
    world_close(&w);
    return c;
}

static void bloom_does_the_work_of_a_bright_pass(void **state) {
    static const char *const modes[] = {"soft", "paper"};
    for (int mode = 0; mode < 2; mode++) {
        size_t with, without;
        float *one = bright_bloom(*state, GPU_RGBA32F, modes[mode], &with);
        float *other = bright_bloom(*state, GPU_RGBA16F, modes[mode], &without);
        assert_int_equal(with, 3);
        assert_int_equal(without, 2);
        double light = sum(one, 117 * 61, 0);
        assert_true(light > 0);
        for (size_t i = 0; i < 4 * 117 * 61; i++)
            assert_true(fabsf(one[i] - other[i]) <= 0.002f * fabsf(one[i]) + 1e-5f);
        mem_free(one);
        mem_free(other);
    }
}

static void history_holds_the_frame_before(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *trail = world_add(&w, NULL, "trail.comp", "trail");
    gpu_test_ok(pass_declare(trail));
    graph_image count = pass_output(trail, "count");
    world_render(&w, 8, 8, count);
    for (int frame = 1; frame <= 5; frame++) {
        float *c = world_read(&w, count);
        assert_true(c[0] == (float)frame);
        mem_free(c);
        gpu_test_ok(gpu_frame_begin(*state));
        gpu_test_ok(graph_execute(w.host.graph, *state));
        gpu_test_ok(gpu_frame_end(*state));
    }
    world_close(&w);
}

static void fragment_shader_is_a_pass_too(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *dot = add_dot(&w), *tint = world_add(&w, NULL, "tint.frag", "tint");
    gpu_test_ok(pass_set_image(tint, "source", pass_output(dot, "color")));
    gpu_test_ok(pass_declare(tint));
    world_render(&w, 16, 16, pass_output(tint, "color"));
    float *c = world_read(&w, pass_output(tint, "color"));
    const float *centre = c + (8 * 16 + 8) * 4;
    assert_true(centre[0] == 8 && centre[1] == 2 && centre[2] == 0.5f && centre[3] == 1);
    mem_free(c);
    world_close(&w);
}

static void misspelt_uniform_gets_the_nearest_name(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, "march", NULL, "march");
    assert_false(pass_set_uniform(p, "stps", number(&w, 1)));
    assert_string_equal(err_get(), "march: unknown uniform 'stps'; did you mean 'steps'?");
    assert_false(pass_set_uniform(p, "steps", number(&w, 0)));
    assert_non_null(strstr(err_get(), "accepted: 1 to 4096"));
    assert_false(pass_set_option(p, "mode", "papr"));
    assert_non_null(strstr(err_get(), "physical, paper"));
    assert_false(pass_set_uniform(p, "albedo", block(&w, 1, 1)));
    assert_non_null(strstr(err_get(), "must not vary in space"));
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bright_keeps_only_what_is_above_the_threshold),
        cmocka_unit_test(bloom_has_the_energy_of_its_input),
        cmocka_unit_test(paper_bloom_adds_energy_with_every_level),
        cmocka_unit_test(bloom_does_the_work_of_a_bright_pass),
        cmocka_unit_test(history_holds_the_frame_before),
        cmocka_unit_test(fragment_shader_is_a_pass_too),
        cmocka_unit_test(misspelt_uniform_gets_the_nearest_name),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
