// How slices round an axis fill space: what a point is made of.
#include "field_slices.h"

static const float pi = 3.14159265358979323846f;

static test_slices *slices(uint32_t count, float3 axis) {
    static test_slices made;
    made.place = field_extrusion_make((float3){0.5f, -1, 2}, axis, 3, 2, count);
    test_slices_fill(&made);
    return &made;
}

// A point by its place round the axis: radius and height in metres.
static float3 around(const field_extrusion *e, float radius, float angle, float height) {
    float3 a = e->along, x = e->across;
    float3 y = {a.y * x.z - a.z * x.y, a.z * x.x - a.x * x.z, a.x * x.y - a.y * x.x};
    float c = radius * cosf(angle), s = radius * sinf(angle);
    return (float3){e->position.x + c * x.x + s * y.x + height * a.x,
                    e->position.y + c * x.y + s * y.y + height * a.y,
                    e->position.z + c * x.z + s * y.z + height * a.z};
}

static void a_slice_is_met_at_its_angle(void **state) {
    (void)state;
    for (uint32_t n = 1; n <= SLICES_MOST; n++) {
        test_slices *s = slices(n, (float3){0, 0, 1});
        for (uint32_t k = 0; k < n; k++)
            for (int left = 0; left < 2; left++) {
                float angle = pi * ((float)k / (float)n + (float)left), r = 1.1f;
                float3 p = around(&s->place, r, angle, 0.7f);
                float across = left ? -r : r;
                const float at[3] = {0.5f + across / 3, 0.35f, ((float)k + 0.5f) / ((float)n + 1)};
                float want = test_slices_sample(s, false, at, 1);
                assert_float_equal(test_slices_scalar(s, p, 1), want, 1e-5f);
            }
    }
}

static void halfway_between_slices_is_their_mean(void **state) {
    (void)state;
    test_slices *s = slices(2, (float3){0, 0, 1});
    // Between slice 1 at 90 degrees and what slice 0 has on its left, at 180.
    const float one[3] = {0.5f + 0.9f / 3, 0.5f, 1.5f / 3},
                left[3] = {0.5f - 0.9f / 3, 0.5f, 0.5f / 3};
    float want =
        0.5f * (test_slices_sample(s, false, one, 0) + test_slices_sample(s, false, left, 0));
    float3 p = around(&s->place, 0.9f, 0.75f * pi, 1);
    assert_float_equal(test_slices_scalar(s, p, 0), want, 1e-5f);
}

static void nothing_jumps_on_the_way_round(void **state) {
    (void)state;
    enum { TURN = 7200 };
    for (uint32_t n = 1; n <= SLICES_MOST; n++) {
        test_slices *s = slices(n, (float3){1, 2, -0.5f});
        float last = 0;
        float3 flow = {0, 0, 0};
        for (int i = 0; i <= TURN; i++) {
            float3 p = around(&s->place, 1.2f, 2 * pi * (float)i / TURN - 0.3f, 0.9f);
            float v = test_slices_scalar(s, p, 2);
            float3 u = test_slices_vector(s, p);
            // Texels are within 1 of 0, and n steps make half a turn.
            float most = 4 * (float)n / TURN * 2 + 1e-4f;
            if (i > 0) {
                assert_float_equal(v, last, most);
                assert_float_equal(u.x, flow.x, most + 4 * pi / TURN);
                assert_float_equal(u.y, flow.y, most + 4 * pi / TURN);
                assert_float_equal(u.z, flow.z, most + 4 * pi / TURN);
            }
            last = v;
            flow = u;
        }
    }
}

static void vectors_turn_with_the_arc(void **state) {
    (void)state;
    test_slices *s = slices(2, (float3){0, 0, 1});
    for (int z = 0; z <= 2; z++)
        for (int y = 0; y < SLICES_Y; y++)
            for (int x = 0; x < SLICES_X; x++) { // outwards, faster above
                float out = x < SLICES_X / 2 ? -1 : 1;
                s->vectors[z][y][x][0] = out * 2;
                s->vectors[z][y][x][1] = 0.25f;
            }
    for (int i = 0; i < 24; i++) {
        float angle = 2 * pi * (float)i / 24 + 0.01f;
        float3 v = test_slices_vector(s, around(&s->place, 1, angle, 1));
        assert_float_equal(v.x, 2 * cosf(angle), 1e-4f);
        assert_float_equal(v.y, 2 * sinf(angle), 1e-4f);
        assert_float_equal(v.z, 0.25f, 1e-4f);
    }
}

static void outside_of_the_cylinder_is_nothing(void **state) {
    (void)state;
    test_slices *s = slices(3, (float3){0, 1, 0});
    const float places[][2] = {{1.501f, 1}, {1, 2.001f}, {1, -0.001f}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 9; k++) {
            float3 p = around(&s->place, places[i][0], (float)k, places[i][1]);
            assert_false(field_extrude(&s->place, p).inside);
            assert_true(test_slices_scalar(s, p, 0) == 0);
        }
    assert_true(field_extrude(&s->place, around(&s->place, 1.499f, 1, 1.999f)).inside);
}

static void its_box_holds_the_cylinder(void **state) {
    (void)state;
    const float3 axes[] = {{0, 0, 1}, {0, 0, -2}, {1, 0, 0}, {0.3f, -0.8f, 0.5f}};
    for (int i = 0; i < 4; i++) {
        test_slices *s = slices(2, axes[i]);
        box3 box = field_extrusion_box(&s->place);
        float3 most = {-1e9f, -1e9f, -1e9f};
        for (int k = 0; k < 720; k++)
            for (int end = 0; end < 2; end++) {
                float3 p = around(&s->place, 1.5f, pi * (float)k / 360, end ? 2 : 0);
                assert_true(p.x >= box.min.x - 1e-4f && p.x <= box.max.x + 1e-4f);
                assert_true(p.y >= box.min.y - 1e-4f && p.y <= box.max.y + 1e-4f);
                assert_true(p.z >= box.min.z - 1e-4f && p.z <= box.max.z + 1e-4f);
                most = (float3){fmaxf(most.x, p.x), fmaxf(most.y, p.y), fmaxf(most.z, p.z)};
            }
        assert_float_equal(most.x, box.max.x, 1e-3f);
        assert_float_equal(most.y, box.max.y, 1e-3f);
        assert_float_equal(most.z, box.max.z, 1e-3f);
    }
}

static void one_slice_goes_on_along_its_normal(void **state) {
    (void)state;
    test_slices *s = slices(4, (float3){0, 0, 1});
    s->place.only = 1;
    float angle = pi / 4;
    for (int i = 0; i < 5; i++) {
        float3 p = around(&s->place, -0.8f, angle, 1.3f);
        p.x += (float)i * sinf(angle); // along the normal
        p.y -= (float)i * cosf(angle);
        const float at[3] = {0.5f - 0.8f / 3, 0.65f, 1.5f / 5};
        assert_float_equal(test_slices_scalar(s, p, 3), test_slices_sample(s, false, at, 3), 1e-4f);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slice_is_met_at_its_angle),
        cmocka_unit_test(halfway_between_slices_is_their_mean),
        cmocka_unit_test(nothing_jumps_on_the_way_round),
        cmocka_unit_test(vectors_turn_with_the_arc),
        cmocka_unit_test(outside_of_the_cylinder_is_nothing),
        cmocka_unit_test(its_box_holds_the_cylinder),
        cmocka_unit_test(one_slice_goes_on_along_its_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
