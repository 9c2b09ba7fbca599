// Where the views of shadow maps stand, and where they lie in the atlas.
#include "base/memory.h"
#include "pass/surfaces/shadow_maps_parts.h"
#include "scene/scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h> // wants the headers above

enum { SIZE = 512 };
static const float margin = 3.5f;

static struct frame_block look(arena *memory, float x, float yaw, float fov) {
    scene s;
    struct frame_block frame = {0};
    field_context context = {0};
    scene_init(&s, memory);
    s.camera.eye = field_constant(memory, 3, (float[4]){x, -0.3f * x, 2});
    s.camera.target = field_constant(
        memory, 3, (float[4]){x + cosf(yaw), -0.3f * x + sinf(yaw), 2 + 0.4f * sinf(3 * yaw)});
    s.camera.fov = field_constant(memory, 1, (float[4]){fov});
    assert_true(scene_fill_frame(&s, &context, 16.0f / 9, &frame));
    return frame;
}

// In clip space, divided.
static void project(const struct shadow_view *v, const float p[3], float out[3]) {
    double sum[4];
    for (int r = 0; r < 4; r++) {
        sum[r] = (double)v->clip.m[12 + r];
        for (int c = 0; c < 3; c++) sum[r] += (double)v->clip.m[4 * c + r] * (double)p[c];
    }
    for (int r = 0; r < 3; r++) out[r] = (float)(sum[r] / sum[3]);
}

// Corner `i` of what a camera sees at a depth.
static void corner(const struct frame_block *f, int i, float deep, float out[3]) {
    const float *m = f->view_inverse.m;
    float x = (i & 1 ? 1.0f : -1.0f) * f->lens.v[0], y = (i & 2 ? 1.0f : -1.0f) * f->lens.v[1];
    for (int c = 0; c < 3; c++) out[c] = f->eye.v[c] + deep * (x * m[c] + y * m[4 + c] - m[8 + c]);
}

static const float suns[][3] = {{0, 0, 1}, {0.6f, 0, 0.8f}, {-0.48f, 0.6f, 0.64f}, {0, 1, 0}};

static void cascades_follow_one_another(void **state) {
    (void)state;
    float even[4], ratio[4], between[4];
    shadow_maps_split(0.1f, 100, 0, 4, even);
    shadow_maps_split(0.1f, 100, 1, 4, ratio);
    shadow_maps_split(0.1f, 100, 0.8f, 4, between);
    assert_true(fabsf(even[0] - 25.075f) < 1e-3f && fabsf(ratio[1] - sqrtf(10)) < 1e-3f);
    for (int i = 0; i < 4; i++) {
        assert_true(i == 0 || between[i] > between[i - 1]);
        assert_true(between[i] <= even[i] + 1e-3f && between[i] >= ratio[i] - 1e-3f);
    }
    assert_true(fabsf(between[3] - 100) < 1e-3f);
}

static void a_cascade_holds_what_the_camera_sees(void **state) {
    (void)state;
    arena memory = {0};
    const float edge = 1 - 2 * margin / SIZE;
    for (int k = 0; k < 200; k++) {
        float fov = 20 + (float)(k % 7) * 15, near = (float)(k % 3),
              far = near + 1 + (float)(k % 11);
        struct frame_block frame = look(&memory, 7.3f * (float)k, 0.31f * (float)k, fov);
        struct shadow_view view;
        float p[3], seen[3];
        shadow_maps_cascade(&frame, suns[k % 4], near, far, 40, SIZE, margin, &view);
        for (int i = 0; i < 8; i++) {
            corner(&frame, i, i < 4 ? near : far, p);
            project(&view, p, seen);
            assert_true(fabsf(seen[0]) <= edge + 1e-3f && fabsf(seen[1]) <= edge + 1e-3f);
            assert_true(seen[2] >= 0 && seen[2] <= 1 + 1e-5f);
            for (int c = 0; c < 3; c++) p[c] += 40 * suns[k % 4][c]; // what shades it
            project(&view, p, seen);
            assert_true(seen[2] >= -1e-5f && seen[2] <= 1);
        }
    }
    arena_free(&memory);
}

// A point that stands still stays at the same place within its texel.
static void a_moving_camera_moves_a_cascade_by_whole_texels(void **state) {
    (void)state;
    arena memory = {0};
    const float p[3] = {3.21f, 1.23f, 0.4f};
    struct shadow_view first = {0};
    for (int k = 0; k < 200; k++) {
        struct frame_block frame = look(&memory, 0.0137f * (float)k, 0.02f * (float)k, 50);
        struct shadow_view view;
        float seen[3], then[3];
        shadow_maps_cascade(&frame, suns[2], 0, 12, 40, SIZE, margin, &view);
        if (k == 0) first = view;
        assert_true(fabsf(view.right.v[3] / first.right.v[3] - 1) < 1e-4f);
        project(&view, p, seen);
        project(&first, p, then);
        for (int c = 0; c < 2; c++) {
            float texels = (seen[c] - then[c]) * SIZE / 2;
            if (fabsf(texels - roundf(texels)) > 0.02f)
                fail_msg("moved by %g texels", (double)texels);
        }
    }
    arena_free(&memory);
}

static void a_spot_is_seen_up_to_its_edge(void **state) {
    (void)state;
    for (int degrees = 5; degrees <= 180; degrees += 25) {
        float half = glm_rad((float)degrees) / 2, slope = tanf(half);
        struct light_entry light = {.position = {{1, 2, 3, 0}},
                                    .axis = {{0, 0.6f, -0.8f, cosf(half)}}};
        struct shadow_view view;
        bool has = shadow_maps_spot(&light, 30, SIZE, margin, &view);
        assert_true(has == ((float)degrees <= SHADOW_WIDEST_SPOT));
        for (int k = 0; has && k < 12; k++) { // around its edge, 4 m away along the axis
            float a = 0.5f * (float)k, p[3], seen[3];
            const float right[3] = {1, 0, 0}, up[3] = {0, 0.8f, 0.6f};
            for (int c = 0; c < 3; c++)
                p[c] = light.position.v[c] +
                       4 * (light.axis.v[c] + slope * (cosf(a) * right[c] + sinf(a) * up[c]));
            project(&view, p, seen);
            float away = hypotf(seen[0], seen[1]);
            assert_true(fabsf(away - (1 - 2 * margin / SIZE)) < 1e-3f);
            assert_true(seen[2] > 0 && seen[2] < 1);
        }
    }
}

static bool apart(const uint32_t a[4], const uint32_t b[4]) {
    return a[0] + a[2] <= b[0] || b[0] + b[2] <= a[0] || a[1] + a[3] <= b[1] || b[1] + b[3] <= a[1];
}

static void squares_fill_the_atlas_and_do_not_overlap(void **state) {
    (void)state;
    enum { MOST = 64 };
    for (uint32_t large = 0; large < 5; large++) {
        for (uint32_t middle = 0; middle < 10; middle += 3) {
            for (uint32_t small = 0; small < 48; small += 6) {
                uint32_t sizes[MOST], places[MOST][4], atlas[2], count = 0;
                uint64_t sum = 0;
                for (uint32_t i = 0; i < large; i++) sizes[count++] = 2048;
                for (uint32_t i = 0; i < middle; i++) sizes[count++] = 1024;
                for (uint32_t i = 0; i < small; i++) sizes[count++] = 256;
                assert_true(shadow_maps_pack(sizes, count, 16384, places, atlas));
                for (uint32_t i = 0; i < count; i++) {
                    sum += (uint64_t)sizes[i] * sizes[i];
                    assert_true(places[i][0] + places[i][2] <= atlas[0]);
                    assert_true(places[i][1] + places[i][3] <= atlas[1]);
                    for (uint32_t k = 0; k < i; k++) assert_true(apart(places[i], places[k]));
                }
                assert_true((uint64_t)atlas[0] * atlas[1] <= 2 * sum + 1);
            }
        }
    }
    uint32_t huge[64], places[64][4], atlas[2];
    for (uint32_t i = 0; i < 64; i++) huge[i] = 4096;
    assert_false(shadow_maps_pack(huge, 64, 16384, places, atlas));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(cascades_follow_one_another),
        cmocka_unit_test(a_cascade_holds_what_the_camera_sees),
        cmocka_unit_test(a_moving_camera_moves_a_cascade_by_whole_texels),
        cmocka_unit_test(a_spot_is_seen_up_to_its_edge),
        cmocka_unit_test(squares_fill_the_atlas_and_do_not_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
