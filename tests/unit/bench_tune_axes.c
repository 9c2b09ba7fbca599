// Which controls of an effect are tuned, with which values.
#include "roil_helper.h"

#include "base/memory.h"
#include "bench/tune.h"
#include <string.h>

static const char EFFECT[] =
    "local fx = effect { name = 'axes' }\n"
    "local steps = param { 'steps', 24, min = 4, max = 60, integer = true }\n"
    "local bake = param { 'noise_bake', 'tile', words = {'exact', 'tile', 'tiny'} }\n"
    "local lumps = param { 'lump_octaves', 3, min = 1, max = 8, integer = true }\n"
    "local baked = param { 'baked', false }\n"
    "local look = param { 'look', 1, min = 0, max = 2 }\n"
    "local ball = sphere { radius = 1 } * perlin { octaves = lumps:get() } * look\n"
    "local lit = lighting { density = ball, shadow_resolution = 192, glow_resolution = 32, sweeps "
    "= 3 }\n"
    "local volume = march { from = lit, steps = steps, resolution = 0.6 }\n"
    "fx.output = final { volume }.color\n"
    "return fx\n";

typedef struct found {
    arena memory;
    tune_axis axes[SEARCH_MAX_AXES];
    size_t count;
    bool done;
} found;

static found find(const char *const *wanted, size_t count) {
    found f = {0};
    roil_effect *e = roil_open(EFFECT, NULL, 0);
    f.done = tune_find_axes(e, wanted, count, &f.memory, f.axes, &f.count);
    roil_unload(e);
    return f;
}

// "name: a [b] c*", where [b] is what it is now and c* the best.
static void assert_axis(const found *f, const char *expected) {
    const char *end = strchr(expected, ':');
    for (size_t i = 0; i < f->count; i++) {
        const tune_axis *a = &f->axes[i];
        if (strncmp(a->name, expected, (size_t)(end - expected)) != 0 ||
            a->name[end - expected] != '\0')
            continue;
        strbuf text = {0};
        strbuf_add(&text, "%s:", a->name);
        for (size_t k = 0; k < a->count; k++)
            strbuf_add(&text, k == a->start ? " [%s]%s" : " %s%s", a->values[k],
                       k == a->reference ? "*" : "");
        assert_string_equal(text.text, expected);
        strbuf_free(&text);
        return;
    }
    fail_msg("no axis %s", expected);
}

static void all_of_quality_and_nothing_else(void **state) {
    (void)state;
    found f = find(NULL, 0);
    assert_true(f.done);
    assert_axis(&f, "steps: 5 6 9 12 18 [24] 36 48*");
    assert_axis(&f, "noise_bake: [tile] tiny exact*");
    assert_axis(&f, "lump_octaves: 1 2 [3]*");
    assert_axis(&f, "baked: true [false]*");
    assert_axis(&f, "lighting.shadow_resolution: 16 32 48 64 96 128 [192] 256*");
    assert_axis(&f, "lighting.glow_resolution: 8 16 24 [32]*");
    assert_axis(&f, "lighting.sweeps: 0 1 2 [3] 4 6 8*");
    assert_axis(&f, "march.resolution: 0.25 0.35 0.5 [0.6] 0.7 1*");
    assert_int_equal(f.count,
                     8); // neither what a parameter moves, nor shadow_steps, which lie idle
    arena_free(&f.memory);
}

static void what_is_named(void **state) {
    (void)state;
    const char *const wanted[] = {"steps=8:24:32", "march.early_exit", "noise_bake=tiny:tile:exact",
                                  "look=0.25:0.5"};
    found f = find(wanted, 4);
    assert_true(f.done);
    assert_axis(&f, "steps: 8 [24] 32*");
    assert_axis(&f, "noise_bake: tiny [tile] exact*");
    assert_axis(&f, "look: 0.25 [0.5]*");
    assert_false(f.axes[0].elsewhere);
    assert_true(f.axes[3].elsewhere); // it is 1 now
    assert_int_equal(f.count, 4);
    assert_string_equal(f.axes[1].name, "march.early_exit");
    arena_free(&f.memory);
}

static void refuses(const char *wanted, const char *says) {
    found f = find(&wanted, 1);
    assert_false(f.done);
    if (!strstr(roil_error(), says)) fail_msg("\"%s\" is not in: %s", says, roil_error());
    arena_free(&f.memory);
}

static void says_what_is_wrong(void **state) {
    (void)state;
    refuses("stesp", "did you mean 'steps'");
    refuses("steps=", "empty");
    refuses("steps=8::16", "empty");
    refuses("steps=8", "two values");
    refuses("steps=1:2:3:4:5:6:7:8:9:10:11:12:13:14:15:16:17", "at most 16");
    refuses("camera.eye", "neither a number nor a word");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_quality_and_nothing_else),
        cmocka_unit_test(what_is_named),
        cmocka_unit_test(says_what_is_wrong),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
