// Ranges on the GPU: against those on the host for every kind, and against values.
#include "../unit/field_random.h"
#include "field_probe.h"

#include "field/range.h"

enum { COUNT = 256 };

static const field_context moving = {.time = 1.3};
static const shader_define with_ranges = {"WITH_RANGES", "1"};

// Boxes of one size, so that a point says which; and a value somewhere inside.
static void gpu_ranges(gpu *g, const field *node, float size, const float (*points)[4],
                       float (*out)[4]) {
    arena memory = {0};
    char expression[128];
    field_root root = {"probe", node, 1, ""};
    field_program *program = field_program_create(&memory, &root, 1);
    gpu_test_ok(program);
    snprintf(expression, sizeof expression,
             "vec4(field_probe_range(p, p + %f), field_probe(p + %f * fract(p)), 0)", (double)size,
             (double)size);
    probe_program(g, program, expression, &with_ranges, &moving, points, COUNT, out);
    arena_free(&memory);
}

static bool near(float there, float host) {
    if (fabsf(host) > 1e12f) return fabsf(there) > 1e11f; // where pow and exp end, they differ
    return fabsf(there - host) <= 1e-3f * fmaxf(1, fabsf(host));
}

static void check(gpu *g, const field *node, float size, bool same, uint32_t *seed) {
    static float points[COUNT][4], got[COUNT][4];
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(seed, 6);
        points[i][0] = p.x, points[i][1] = p.y, points[i][2] = p.z;
    }
    gpu_ranges(g, node, size, points, got);
    for (int i = 0; i < COUNT; i++) {
        float low = got[i][0], high = got[i][1], v = got[i][2];
        float slack = 1e-5f * fmaxf(1, fabsf(v));
        bool holds = (v >= low - slack || low <= -1e30f) && (v <= high + slack || high >= 1e30f);
        float3 p = {points[i][0], points[i][1], points[i][2]};
        intervals host;
        assert_true(
            field_ranges(node, &moving, (box3){p, {p.x + size, p.y + size, p.z + size}}, &host));
        bool agrees = !same || (near(low, host.c[0].low) && near(high, host.c[0].high));
        if ((holds || isnan(v)) && agrees) continue;
        strbuf text = {0};
        field_print(node, &text);
        fail_msg("%.9g; %.9g to %.9g on the GPU, %.9g to %.9g on the host; at (%g %g %g), %g: %s",
                 (double)v, (double)low, (double)high, (double)host.c[0].low,
                 (double)host.c[0].high, (double)p.x, (double)p.y, (double)p.z, (double)size,
                 strbuf_text(&text));
    }
}

static field *first(field *node) {
    return node->components == 1 ? node : need_field(field_swizzle(build_memory(), node, "x"));
}

static void every_kind_has_the_range_of_its_twin(void **state) {
    uint32_t seed = 4;
    for (const field_kind *kind = &field_kinds[KIND_WARP]; kind->name; kind++)
        for (int i = 0; i < 2; i++) {
            int components = kind->components ? kind->components : i % 2 ? 1 : 3;
            field *node = random_kind(&seed, kind, 0, components);
            if (node) check(*state, first(node), i ? 0.5f : 0.02f, true, &seed);
        }
}

static void random_expressions_stay_in_their_ranges(void **state) {
    uint32_t seed = 17;
    for (int i = 0; i < 12; i++)
        check(*state, random_tree(&seed, 1 + i % 3, 1), i % 2 ? 0.3f : 0.03f, false, &seed);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_has_the_range_of_its_twin),
        cmocka_unit_test(random_expressions_stay_in_their_ranges),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
