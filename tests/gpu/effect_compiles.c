// What compiles shaders and what does not: structure does, numbers never.
#include "effect_test.h"
#include <ftw.h>
#include <unistd.h>

enum { SIZE = 17 };

typedef struct numbers { // what may differ between two effects of one structure
    float density, frequency, radius, brightness;
    const char *noise; // kind: structure
    const effect_setting *settings;
    size_t setting_count;
    const char *cache;
} numbers;

static const palette *make_palette(effect *e, float brightness) {
    const palette_stop dark[] = {{0, {0, 0, 0, 0}}, {1, {brightness, 0.1f, 0, 1}}};
    const palette_stop light[] = {
        {0, {0, 0, 0, 0}}, {0.5f, {2 * brightness, 1, 0, 1}}, {1, {brightness, 0, 2, 1}}};
    const palette_key keys[] = {{0, dark, COUNT_OF(dark)}, {0.5f, light, COUNT_OF(light)}};
    const palette *p = palette_create(
        effect_memory(e), &(palette_desc){.max = 1, .keys = keys, .key_count = COUNT_OF(keys)});
    gpu_test_ok(p);
    return p;
}

// A noisy ball, coloured by a palette that moves, over a crate, with bloom.
static effect *open_ball(gpu *device, numbers n) {
    effect *e = open_effect(&(effect_desc){.device = device,
                                           .settings = n.settings,
                                           .setting_count = n.setting_count,
                                           .cache_dir = n.cache});
    gpu_test_ok(effect_set_timeline(e, 10, 100, 1));
    const field *radius = param(e, "radius", n.radius, 2);
    const field *ball = make(e, "sphere", triple(e, 0, 0, 0), radius, number(e, 0.2f));
    const field *noise = make(e, n.noise, param(e, "frequency", n.frequency, 10));
    const field *density =
        make(e, "mul", make(e, "mul", ball, noise), param(e, "density", n.density, 50));
    const field *color = field_palette(effect_memory(e), make_palette(e, n.brightness), noise);
    gpu_test_ok(color);
    pass *geometry = add(e, "geometry", NULL), *shade = add(e, "shade", NULL);
    gpu_test_ok(pass_declare(geometry));
    pass_add_source(shade, geometry);
    gpu_test_ok(pass_set_uniform(shade, "sky_alpha", number(e, 0)));
    gpu_test_ok(pass_declare(shade));
    pass *march = add(e, "march", NULL), *over = add(e, "over", NULL),
         *last = add(e, "final", NULL);
    gpu_test_ok(pass_set_field(march, "density", density));
    gpu_test_ok(pass_set_field(march, "radiance", field_swizzle(effect_memory(e), color, "rgb")));
    gpu_test_ok(pass_set_image(march, "depth", pass_output(geometry, "depth")));
    gpu_test_ok(pass_declare(march));
    gpu_test_ok(pass_set_image(over, "volume", pass_output(march, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(shade, "color")));
    gpu_test_ok(pass_declare(over));
    gpu_test_ok(pass_set_option(last, "tonemap", "none"));
    gpu_test_ok(pass_set_image(last, "source", pass_output(over, "color")));
    finish(e, last, SIZE, SIZE);
    return e;
}

static const numbers plain = {2, 1.5f, 1, 1, "perlin", NULL, 0, NULL};

static void numbers_do_not_compile(void **state) {
    effect *e = open_ball(*state, plain);
    uint64_t before = shader_library_compiles(effect_library(e));
    assert_true(before >= 4);
    float last = middle(e, 1, SIZE, 0);
    static const struct {
        const char *name, *text;
    } changes[] = {{"density", "3"},     {"frequency", "3"},          {"radius", "0.6"},
                   {"march.steps", "3"}, {"final.exposure_ev", "-1"}, {"march.step_size", "0.1"}};
    for (size_t i = 0; i < COUNT_OF(changes); i++) {
        gpu_test_ok(effect_set(e, changes[i].name, changes[i].text));
        float now = middle(e, 1, SIZE, 0);
        if (now == last) fail_msg("%s changed nothing", changes[i].name);
        last = now;
    }
    for (int frame = 2; frame <= 6; frame++) { // the keys of the palette lie half a second apart
        float now = middle(e, frame, SIZE, 0);
        assert_true(now > last);
        last = now;
    }
    gpu_test_ok(effect_build(e, 2 * SIZE, 2 * SIZE)); // nor does another size
    assert_true(middle(e, 20, 2 * SIZE, 3) > 0);
    assert_int_equal(shader_library_compiles(effect_library(e)), before);
    effect_destroy(e);
}

// ---- from one effect to the next ----------------------------------------------------------------

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

static uint64_t compiles_of(gpu *device, numbers n) {
    effect *e = open_ball(device, n);
    gpu_test_ok(effect_render(e, 1, false));
    uint64_t count = shader_library_compiles(effect_library(e));
    effect_destroy(e);
    return count;
}

static void only_structure_misses_the_cache(void **state) {
    char cache[] = "/tmp/roil-effect-XXXXXX";
    assert_non_null(mkdtemp(cache));
    numbers n = plain;
    n.cache = cache;
    assert_true(compiles_of(*state, n) >= 4);
    assert_int_equal(compiles_of(*state, n), 0);

    numbers other = {9, 0.3f, 0.5f, 6, "perlin", NULL, 0, cache}; // and other palette keys
    assert_int_equal(compiles_of(*state, other), 0);

    const effect_setting steps = {"march.steps", "17", NULL},
                         scale = {"march.resolution", "0.5", NULL};
    other.settings = &steps;
    other.setting_count = 1;
    assert_int_equal(compiles_of(*state, other), 0);
    other.settings = &scale; // a GPU lets several threads share a ray of a smaller picture
    const int software = gpu_get_info(*state)->kind == GPU_CPU;
    assert_int_equal(compiles_of(*state, other), !software);

    const effect_setting mode = {"march.mode", "paper", NULL};
    other.settings = &mode;
    // Of that pass alone, which has three shaders, and one for rays beside the volume in software.
    assert_int_equal(compiles_of(*state, other), 3 + software);
    assert_int_equal(compiles_of(*state, other), 0);

    numbers simplex = n;
    simplex.noise = "simplex";
    assert_int_equal(compiles_of(*state, simplex), 2); // those that look at the fields
    nftw(cache, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_do_not_compile),
        cmocka_unit_test(only_structure_misses_the_cache),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
