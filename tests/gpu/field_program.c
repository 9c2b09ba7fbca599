// Generated functions on the GPU against evaluation on the host: whatever was skipped, kept or
// moved by the generator, the values stay.
#include "../unit/field_build.h"
#include "field_probe.h"

enum { COUNT = 2048 };

static void compare(void **state, const field_root *roots, size_t count, const char *expression,
                    const field *const want[4]) {
    static float points[COUNT][4], got[COUNT][4];
    arena memory = {0};
    uint32_t seed = 77;
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(&seed, 4);
        points[i][0] = p.x, points[i][1] = p.y, points[i][2] = p.z;
    }
    field_program *program = field_program_create(&memory, roots, count);
    gpu_test_ok(program);
    probe_program(*state, program, expression, NULL, &(field_context){0}, points, COUNT, got);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 4 && want[c]; c++) {
            float v = value_at(want[c], 0, (float3){points[i][0], points[i][1], points[i][2]});
            if (!(fabsf(got[i][c] - v) <= 1e-3f * fmaxf(1, fabsf(v))))
                fail_msg("component %d: %g on the GPU, %g on the host\n%s", c, (double)got[i][c],
                         (double)v, field_program_text(program));
        }
    arena_free(&memory);
}

static field *noise_of(const char *kind, int seed) {
    return row(kind, SET("seed", number((float)seed)), SET("octaves", number(1)));
}

static field *ball(float x) {
    return row("sphere", SET("position", vector(x, 0, 0)), SET("falloff", number(0.5f)));
}

static void lazy_noise_keeps_its_value(void **state) {
    field *noise = noise_of("perlin", 1), *swirl = noise_of("curl", 2);
    field *warped = make("warp", noise_of("worley", 3), swirl, number(0.3f));
    field *a = make("mul", make("mul", ball(-0.5f), noise), warped);
    field *b = make("mul", ball(0.5f), make("sub", warped, noise));
    field *sum = make("add", a, b);
    field_root root = {"probe", sum, 1, ""};
    compare(state, &root, 1, "vec4(field_probe(p), 0, 0, 0)", (const field *[4]){sum});
}

static void fields_after_others_agree(void **state) {
    field *noise = noise_of("perlin", 1), *cells = noise_of("worley", 2);
    field *density = make("mul", make("mul", ball(0), make("mix", number(1), noise)),
                          make("max", make("mul", ball(0.5f), cells), number(0)));
    field *heat = make("add", make("mul", noise, number(3)), cells);
    field *tint = make("mul", heat, make("mul", density, cells));
    field_root roots[] = {
        {"density", density, 1, ""},
        {"heat", heat, 1, "density"},
        {"other", make("add", cells, noise), 1, ""},
        {"tint", tint, 1, "heat"},
    };
    // A marcher's way: the later ones only where the first is not zero.
    const char *expression =
        "vec4(0); float d = field_density(p); if (d != 0.0) { float h = field_heat(p); "
        "results[i] = vec4(d, h, h != 0.0 ? field_tint(p) : 0.0, field_other(p)); return; } "
        "results[i] = vec4(0, -1, -1, field_other(p + vec3(0)))";
    field *zero = make("step", make("abs", density), number(1e-30f)); // 1 where it is not zero
    field *masked_heat = make("mix", number(-1), heat, zero);
    field *masked_tint = make("mix", number(-1), tint, zero);
    compare(state, roots, 4, expression,
            (const field *[4]){density, masked_heat, masked_tint, roots[2].node});
}

// Every step uses the one before in two products: lazy functions would nest twelve deep.
static void deep_sharing_keeps_its_value(void **state) {
    field *x = make("mul", ball(0), noise_of("perlin", 100));
    for (int i = 0; i < 12; i++)
        x = make("add", make("mul", x, noise_of("perlin", 2 * i)),
                 make("mul", x, noise_of("value", 2 * i + 1)));
    field_root root = {"probe", x, 1, ""};
    compare(state, &root, 1, "vec4(field_probe(p), 0, 0, 0)", (const field *[4]){x});
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(lazy_noise_keeps_its_value),
        cmocka_unit_test(fields_after_others_agree),
        cmocka_unit_test(deep_sharing_keeps_its_value),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
