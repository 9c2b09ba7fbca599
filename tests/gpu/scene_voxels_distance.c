// Signed distances to bodies.
#include "voxels_test.h"

static const box3 around = {{-2, -2, -2}, {2, 2, 2}};
enum { N = 32, CELLS = N * N * N };
static const float edge = 4.0f / N;

static gpu_image *make_image(gpu *g, gpu_format format) {
    gpu_image *image =
        gpu_image_create(g, &(gpu_image_desc){.label = "cells",
                                              .format = format,
                                              .width = N,
                                              .height = N,
                                              .depth = N,
                                              .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    gpu_test_ok(image);
    return image;
}

// Halves of an r16f image; free with mem_free.
static float *distances_of(voxels_world *w, const voxels_body *bodies, size_t count) {
    voxels *v = make_voxels(w, &(voxels_desc){around, {N, N, N}, bodies, count, .distances = true});
    gpu_image *image = make_image(w->device, GPU_R16F);
    voxels_change change;
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(voxels_update(v, w->device, &w->context, 0, &change));
    gpu_test_ok(voxels_write_distance(v, w->device, image));
    gpu_test_ok(gpu_frame_end(w->device));
    uint16_t *halves = mem_alloc(CELLS * sizeof *halves);
    gpu_test_ok(gpu_image_read(w->device, image, halves, CELLS * sizeof *halves));
    float *out = mem_alloc(CELLS * sizeof *out);
    for (int i = 0; i < CELLS; i++) out[i] = half_to_float(halves[i]);
    mem_free(halves);
    gpu_image_destroy(w->device, image);
    voxels_destroy(v, w->device);
    return out;
}

static float3 centre_of(int i) {
    return (float3){-2 + edge * ((float)(i % N) + 0.5f), -2 + edge * ((float)(i / N % N) + 0.5f),
                    -2 + edge * ((float)(i / N / N) + 0.5f)};
}

// Halves are stored by cutting off what they cannot hold: 1/1024 of the value.
static void expect_distance(const float *got, float (*want)(float3 p), float near, float far) {
    for (int i = 0; i < CELLS; i++) {
        float right = want(centre_of(i));
        float most = (fabsf(right) < 3 * edge ? near : far) + fabsf(right) / 1000;
        if (fabsf(got[i] - right) > most)
            fail_msg("cell %d %d %d: %g instead of %g", i % N, i / N % N, i / N / N, (double)got[i],
                     (double)right);
    }
}

static float to_sphere(float3 p) {
    return sqrtf(p.x * p.x + p.y * p.y + p.z * p.z) - 1;
}

static float to_box(float3 p) { // of half sides 1, 0.5, 0.75
    float x = fabsf(p.x) - 1, y = fabsf(p.y) - 0.5f, z = fabsf(p.z) - 0.75f;
    float a = fmaxf(x, 0), b = fmaxf(y, 0), c = fmaxf(z, 0);
    return sqrtf(a * a + b * b + c * c) + fminf(fmaxf(x, fmaxf(y, z)), 0);
}

static float to_both(float3 p) {
    return fminf(to_sphere((float3){2 * p.x - 2, 2 * p.y, 2 * p.z}) / 2,
                 to_sphere((float3){2 * p.x + 2, 2 * p.y, 2 * p.z}) / 2);
}

static void distances_are_those_of_shapes(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    shape_sphere(&s, 40);
    scene_mesh *ball = shape_mesh(&w, &s);
    shape_box(&s, (float3){-1, -0.5f, -0.75f}, (float3){1, 0.5f, 0.75f});
    scene_mesh *box = shape_mesh(&w, &s);
    float *got = distances_of(&w, &(voxels_body){ball, VOXELS_AUTO}, 1);
    expect_distance(got, to_sphere, 0.03f * edge, 0.05f * edge); // of facets: 1/650 of the radius
    mem_free(got);
    got = distances_of(&w, &(voxels_body){box, VOXELS_AUTO}, 1);
    expect_distance(got, to_box, 0.01f * edge, 0.05f * edge);
    mem_free(got);
    scene_mesh other = *ball;
    ball->scale = other.scale = number(&w, 0.5f);
    ball->position = triple(&w, 1, 0, 0);
    other.position = triple(&w, -1, 0, 0);
    const voxels_body both[] = {{ball, VOXELS_AUTO}, {&other, VOXELS_AUTO}};
    got = distances_of(&w, both, 2);
    expect_distance(got, to_both, 0.03f * edge, 0.05f * edge);
    mem_free(got);
    voxels_close(&w);
}

static void distance_to_a_sheet_has_no_sign_and_to_nothing_no_end(void **state) {
    voxels_world w;
    voxels_open(&w, *state);
    shape s = {0};
    for (int i = 0; i < 4; i++) shape_vertex(&s, i & 1 ? 3 : -3, i & 2 ? 3 : -3, 0.3f);
    shape_triangle(&s, 0, 1, 3);
    shape_triangle(&s, 0, 3, 2);
    float *got = distances_of(&w, &(voxels_body){shape_mesh(&w, &s), VOXELS_AUTO}, 1);
    for (int i = 0; i < CELLS; i++)
        assert_true(fabsf(got[i] - fabsf(centre_of(i).z - 0.3f)) < 0.03f * edge);
    mem_free(got);
    got = distances_of(&w, NULL, 0);
    for (int i = 0; i < CELLS; i++) assert_true(got[i] > 6.9f && got[i] < 7); // across the box
    mem_free(got);
    voxels_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_those_of_shapes),
        cmocka_unit_test(distance_to_a_sheet_has_no_sign_and_to_nothing_no_end),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
