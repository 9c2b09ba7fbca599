// Every kind on the GPU against its twin in C, at thousands of points.
#include "../unit/field_build.h"
#include "field_probe.h"

static void agree(void **state, const field *node, float tolerance) {
    enum { COUNT = 4096 };
    static float points[COUNT][4], got[COUNT][4];
    field_context context = {.time = 1.75};
    uint32_t seed = 12345;
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(&seed, i % 2 ? 4 : 40);
        points[i][0] = p.x, points[i][1] = p.y, points[i][2] = p.z;
    }
    probe(*state, node, &context, points, COUNT, got);
    for (int i = 0; i < COUNT; i++) {
        float want[4];
        float3 p = {points[i][0], points[i][1], points[i][2]};
        assert_true(field_eval(node, &context, p, want));
        for (int c = 0; c < node->components; c++) {
            float scale = fmaxf(1, fabsf(want[c]));
            if (!(fabsf(got[i][c] - want[c]) <= tolerance * scale)) {
                strbuf text = {0};
                field_print(node, &text);
                fail_msg("at (%.9g, %.9g, %.9g), component %d: %.9g on the GPU, %.9g on the host; "
                         "%s",
                         (double)p.x, (double)p.y, (double)p.z, c, (double)got[i][c],
                         (double)want[c], strbuf_text(&text));
            }
        }
    }
}

#define MOTION                                                                                     \
    SET("drift", vector(0.1f, 0.15f, 0.2f)), SET("speed", number(0.7f)),                           \
        SET("octaves", number(3)), SET("frequency", number(1.3f)), SET("seed", number(7)),         \
        SET("amplitude", number(0.8f)), SET("lacunarity", number(2)), SET("w", number(-2.4f))

static void lattice_noises_agree(void **state) {
    static const char *const kinds[] = {"perlin", "value"};
    static const char *const fractals[] = {"fbm", "ridged", "billow"};
    for (int k = 0; k < 2; k++)
        for (int four = 0; four < 2; four++) {
            const char *dimensions = four ? "4" : "3";
            agree(state, row(kinds[k], MOTION, WORD("dimensions", dimensions)), 1e-4f);
            agree(state,
                  row(kinds[k], MOTION, SET("period", number(5)), WORD("dimensions", dimensions)),
                  1e-4f);
            for (int f = 1; f < 3; f++)
                agree(state,
                      row(kinds[k], MOTION, WORD("fractal", fractals[f]),
                          WORD("dimensions", dimensions)),
                      1e-4f);
        }
}

static void simplex_agrees(void **state) {
    agree(state, row("simplex", MOTION), 1e-4f);
    agree(state, row("simplex", MOTION, WORD("dimensions", "4")), 1e-4f);
    agree(state, row("simplex", MOTION, WORD("fractal", "ridged")), 1e-4f);
    agree(state, row("simplex", MOTION, SET("period", number(6))), 1e-4f);
    agree(state, row("simplex", MOTION, SET("period", number(6)), WORD("dimensions", "4")), 1e-4f);
}

static void worley_agrees(void **state) {
    static const char *const distances[] = {"f1", "f2", "f2_f1"};
    for (int d = 0; d < 3; d++)
        for (int four = 0; four < 2; four++)
            agree(state,
                  row("worley", MOTION, SET("power", number(1.5f)), WORD("distance", distances[d]),
                      WORD("dimensions", four ? "4" : "3")),
                  1e-4f);
    agree(state, row("worley", MOTION, SET("period", number(4))), 1e-4f);
}

// The fract hash magnifies roundings, hence its arithmetic is exact on both sides; what remains is
// that of the distance.
static void the_papers_worley_agrees(void **state) {
    agree(state,
          row("worley", WORD("mode", "paper"), SET("frequency", number(2)),
              SET("power", number(1.5f)), SET("octaves", number(2))),
          1e-4f);
    agree(state,
          row("worley", WORD("mode", "paper"), WORD("dimensions", "4"), SET("speed", number(2))),
          1e-4f);
}

static void curls_agree(void **state) {
    agree(state, row("curl", SET("octaves", number(3)), SET("drift", vector(1, 2, 3))), 1e-4f);
    agree(state, row("curl", WORD("dimensions", "4"), SET("speed", number(2))), 1e-4f);
    agree(state, row("curl", SET("period", number(3)), SET("amount", number(5))), 1e-4f);
    agree(state,
          row("curl", WORD("mode", "paper"), SET("step", number(0.01f)), SET("amount", number(5)),
              SET("octaves", number(2))),
          1e-4f);
}

static void shapes_agree(void **state) {
    agree(state,
          row("sphere", SET("position", vector(0.2f, 0, -0.3f)), SET("radius", number(1.5f)),
              SET("falloff", number(0.5f))),
          1e-4f);
    agree(state,
          row("box", SET("position", vector(0.1f, 0.2f, 0.3f)), SET("size", vector(1, 2, 3)),
              SET("falloff", number(0.3f))),
          1e-4f);
    agree(state,
          row("capsule", SET("from", vector(-1, 0, 0)), SET("to", vector(1, 0.5f, 2)),
              SET("radius", number(0.7f)), SET("falloff", number(0.4f))),
          1e-4f);
    agree(state,
          row("torus", SET("radius", number(1.4f)), SET("thickness", number(0.5f)),
              SET("falloff", number(0.2f))),
          1e-4f);
}

// Two are long past, one has not begun, and of one the front is among the points.
static void bursts_agree(void **state) {
    static const float ages[] = {-1, 0.004f, 0.05f, 3};
    for (size_t i = 0; i < COUNT_OF(ages); i++) {
        field *age = number(ages[i]), *place = vector(0.2f, 0, -0.3f);
        field *pressure = row("blast_pressure", SET("position", place), SET("age", age),
                              SET("charge", number(0.5f)));
        agree(state, make("mul", pressure, number(1e-5f)), 1e-4f); // of an atmosphere
        agree(state,
              row("blast_velocity", SET("position", place), SET("age", age),
                  SET("charge", number(20))),
              1e-3f);
    }
    agree(state, row("blast_impulse", SET("charge", number(3))), 1e-4f);
    agree(state, row("blast_arrival", SET("charge", number(3))), 1e-5f);
    agree(state, row("blast_arrival", SET("charge", number(1e6f))), 1e-6f);
}

static void operators_agree(void **state) {
    field *p = make("position", NULL), *x = need_field(field_swizzle(build_memory(), p, "x"));
    field *y = need_field(field_swizzle(build_memory(), p, "y"));
    static const char *const unary[] = {"negate", "abs",   "sqrt",  "exp",
                                        "sin",    "floor", "fract", "length"};
    for (size_t i = 0; i < COUNT_OF(unary); i++) {
        agree(state, make(unary[i], make("mul", x, number(0.2f))), 1e-4f);
        agree(state, make(unary[i], make("mul", p, vector(0.2f, 0.1f, 0.3f))), 1e-4f);
    }
    static const char *const binary[] = {"add", "sub", "mul", "div", "min",
                                         "max", "dot", "pow", "step"};
    for (size_t i = 0; i < COUNT_OF(binary); i++) {
        field *a = make("mul", p, number(0.1f)), *b = make("add", y, number(50));
        agree(state, make(binary[i], x, make("mul", b, number(0.05f))), 1e-4f);
        agree(state, make(binary[i], a, make("mul", b, number(0.05f))), 1e-4f);
        agree(state, make(binary[i], p, p), binary[i][0] == 'p' ? 1e-2f : 1e-4f);
    }
    agree(state, make("atan", y, x), 1e-4f);
    agree(state, make("atan", number(0), number(0)), 0);
    agree(state, make("div", x, number(0)), 0);
    agree(state, make("mix", p, x, number(0.3f)), 1e-4f);
    agree(state, make("mix", p, x, make("mul", y, number(0.1f))), 1e-4f);
    agree(state, make("clamp", p, number(-0.5f), vector(0.5f, 1, 2)), 1e-4f);
    agree(state, make("remap", p, number(-1), number(3), number(10), number(20)), 1e-4f);
    agree(state, make("remap", p, number(1), number(1), number(10), number(20)), 1e-4f);
    agree(state, make("smoothstep", p, number(-1), number(1)), 1e-4f);
    agree(state, make("smoothstep", p, number(1), number(1)), 0);
    agree(state, make("vec", y, number(4), x), 0);
    agree(state, need_field(field_swizzle(build_memory(), p, "zyx")), 0);
    agree(state, need_field(field_swizzle(build_memory(), p, "bbrg")), 0);
    agree(state, need_field(field_swizzle(build_memory(), x, "xxx")), 0);
}

static void moved_fields_agree(void **state) {
    field *ball = make("torus", NULL, number(1), number(0.6f), number(0.5f));
    field *swirl = row("curl", SET("octaves", number(2)));
    agree(state, make("warp", ball, swirl, number(0.2f)), 1e-3f);
    agree(state, make("warp", make("warp", ball, swirl, number(0.2f)), swirl, number(0.1f)), 1e-3f);
    agree(state,
          make("transform", ball, vector(0.3f, 0.4f, 0.1f), vector(30, -50, 70),
               vector(1, 1.5f, 0.5f)),
          1e-3f);
    agree(state,
          make("transform",
               make("warp", make("transform", ball, vector(1, 0, 0)), make("position", NULL),
                    number(0.1f)),
               NULL, vector(0, 0, 90)),
          1e-3f);
}

static void advected_fields_agree(void **state) {
    field *cells = row("worley", SET("octaves", number(2)), SET("seed", number(5)));
    field *swirl = row("curl", SET("octaves", number(2)));
    agree(state, make("advect", cells, swirl, number(0.7f)), 1e-3f);
    agree(state,
          row("advect", SET("value", make("warp", cells, swirl, number(0.1f))),
              SET("velocity", make("add", swirl, vector(0, 0, 2))), SET("period", number(0.6f)),
              WORD("phases", "3"), WORD("path", "curved")),
          1e-3f);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattice_noises_agree), cmocka_unit_test(simplex_agrees),
        cmocka_unit_test(worley_agrees),        cmocka_unit_test(the_papers_worley_agrees),
        cmocka_unit_test(curls_agree),          cmocka_unit_test(shapes_agree),
        cmocka_unit_test(bursts_agree),         cmocka_unit_test(operators_agree),
        cmocka_unit_test(moved_fields_agree),   cmocka_unit_test(advected_fields_agree),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
