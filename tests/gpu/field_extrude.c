// Slices round an axis on the GPU: the generated samples against the host's.
#include "../unit/field_build.h"
#include "../unit/field_slices.h"
#include "base/maths.h"
#include "field_probe.h"

enum { COUNT = 512 };

static gpu_image *image_of(gpu *g, const float (*texels)[SLICES_Y][SLICES_X][4], uint32_t layers) {
    static uint16_t halves[SLICES_LAYERS * SLICES_Y * SLICES_X * 4];
    size_t count = (size_t)layers * SLICES_Y * SLICES_X * 4;
    for (size_t i = 0; i < count; i++) halves[i] = half_from_float((&texels[0][0][0][0])[i]);
    gpu_image *made = gpu_image_create(g, &(gpu_image_desc){.label = "slices",
                                                            .format = GPU_RGBA16F,
                                                            .width = SLICES_X,
                                                            .height = SLICES_Y,
                                                            .depth = layers,
                                                            .use = GPU_USE_SAMPLED});
    gpu_test_ok(made);
    gpu_test_ok(gpu_image_write(g, made, 0, halves, count * sizeof *halves));
    return made;
}

static void check(gpu *g, const test_slices *s, const field_grid *grid, float slack) {
    static float points[COUNT][4], scalars[COUNT][4], vectors[COUNT][4];
    uint32_t seed = 5;
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(&seed, 2);
        points[i][0] = p.x, points[i][1] = p.y, points[i][2] = p.z;
    }
    field *scalar = field_grid_channel(build_memory(), grid, 2, 1);
    probe(g, scalar, &(field_context){0}, points, COUNT, scalars);
    field *flow = field_grid_channel(build_memory(), grid, 4, 3);
    probe(g, flow, &(field_context){0}, points, COUNT, vectors);
    int inside = 0;
    for (int i = 0; i < COUNT; i++) {
        float3 p = {points[i][0], points[i][1], points[i][2]};
        field_extruded e = field_extrude(&s->place, p);
        float edge = fmaxf(fabsf(e.at[0] - 0.5f), fabsf(e.at[1] - 0.5f));
        if (fabsf(edge - 0.5f) < 1e-5f) continue; // either side of it
        inside += e.inside;
        float3 v = test_slices_vector(s, p);
        assert_float_equal(scalars[i][0], test_slices_scalar(s, p, 2), slack);
        assert_float_equal(vectors[i][0], v.x, slack);
        assert_float_equal(vectors[i][1], v.y, slack);
        assert_float_equal(vectors[i][2], v.z, slack);
    }
    assert_true(inside > COUNT / 16 && inside < COUNT);
}

static void samples_are_those_of_the_host(void **state) {
    static test_slices s;
    gpu *g = *state;
    for (uint32_t n = 1; n <= SLICES_MOST; n++)
        for (int only = -1; only < (int)n; only += 2) {
            s.place = field_extrusion_make((float3){0.2f, 0.1f, -0.7f}, (float3){0.5f, 0.2f, 1},
                                           2.5f, 1.6f, n);
            s.place.only = only;
            s.place.vectors = 1u << 1;
            test_slices_fill(&s);
            field_grid grid = {.name = "slices",
                               .box = field_extrusion_box(&s.place),
                               .size = {SLICES_X, SLICES_Y, n + 1},
                               .channel_count = 8,
                               .extruded = &s.place};
            grid.state.active = box3_infinite();
            grid.state.images[0][0] = image_of(g, s.scalars, n + 1);
            grid.state.images[0][1] = image_of(g, s.vectors, n + 1);
            // Filters weigh texels by 1/256.
            check(g, &s, &grid, 3.0f / 256);
            for (int i = 0; i < 2; i++) gpu_image_destroy(g, grid.state.images[0][i]);
        }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_are_those_of_the_host),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
