// Where things lie: frames on the bar of time, an image in the inspector.
#include "app/image_view.h"
#include "app/track.h"
#include "unit/base_test.h"
#include <math.h>

static bool near(double a, double b) {
    return fabs(a - b) < 1e-4 * (1 + fabs(b));
}

// ---- track --------------------------------------------------------------------------------------

static const track bar = {1, 101, 50, 550};

static void frames_lie_from_left_to_right(void **state) {
    (void)state;
    assert_true(near(track_x(&bar, 1), 50));
    assert_true(near(track_x(&bar, 51), 300));
    assert_true(near(track_x(&bar, 101), 550));
    for (double f = 1; f <= 101; f += 12.5)
        assert_true(near(track_frame(&bar, track_x(&bar, f)), f));
}

static void what_is_beside_the_bar_is_its_end(void **state) {
    (void)state;
    assert_true(track_frame(&bar, -1000) == 1);
    assert_true(track_frame(&bar, 5000) == 101);
}

static void a_bar_of_one_frame_or_no_width(void **state) {
    (void)state;
    const track single = {5, 5, 50, 550}, thin = {1, 100, 50, 50}, none = {1, 100, 50, 20};
    assert_true(track_frame(&single, 300) == 5);
    assert_true(near(track_x(&single, 5), 50));
    assert_true(track_frame(&thin, 50) == 1);
    assert_true(track_frame(&none, 40) == 1);
    assert_true(track_ticks_of(&single, 60).step >= 1);
    assert_true(track_ticks_of(&thin, 60).step >= 1);
    assert_true(track_ticks_of(&none, 60).step >= 1);
}

static void ticks_are_round_and_far_apart(void **state) {
    (void)state;
    const struct {
        double last;
        float least;
        double step, between;
    } rows[] = {
        {101, 60, 20, 10}, {101, 20, 5, 1},      {101, 5, 1, 0},     {11, 60, 2, 1},
        {11, 40, 1, 0},    {1001, 60, 200, 100}, {1001, 20, 50, 10}, {501, 40, 50, 10},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const track t = {1, rows[i].last, 50, 550};
        track_ticks ticks = track_ticks_of(&t, rows[i].least);
        assert_true(ticks.step == rows[i].step);
        assert_true(ticks.between == rows[i].between);
    }
}

// ---- image --------------------------------------------------------------------------------------

static const float wide[2] = {400, 200}, view_size[2] = {800, 800};

// Texel of the image under a place of the view, counted from its centre.
static float texel_at(const image_view *v, int axis, float pixels, const float image[2]) {
    return v->center[axis] * image[axis] + pixels / v->zoom;
}

static void fit_shows_all_of_it(void **state) {
    (void)state;
    image_view v = {.fit = true};
    image_view_fit(&v, view_size, wide);
    assert_true(near((double)v.zoom, 2));
    assert_true(v.center[0] == 0.5f && v.center[1] == 0.5f);
    const float tall[2] = {100, 1600};
    image_view_fit(&v, view_size, tall);
    assert_true(near((double)v.zoom, 0.5));
    v = (image_view){{0.2f, 0.3f}, 3, false};
    image_view_fit(&v, view_size, wide);
    assert_true(v.zoom == 3 && v.center[0] == 0.2f);
}

static void a_pan_moves_with_the_hand(void **state) {
    (void)state;
    image_view v = {{0.5f, 0.5f}, 4, true};
    float x = texel_at(&v, 0, 10, wide), y = texel_at(&v, 1, -20, wide);
    image_view_pan(&v, 40, -60, wide);
    assert_true(near((double)texel_at(&v, 0, 50, wide), (double)x));
    assert_true(near((double)texel_at(&v, 1, -80, wide), (double)y));
    assert_false(v.fit);
    image_view_pan(&v, -1e6f, 1e6f, wide);
    assert_true(v.center[0] == 1 && v.center[1] == 0);
}

static void zoom_keeps_what_is_under_the_pointer(void **state) {
    (void)state;
    image_view v = {{0.5f, 0.5f}, 2, true};
    float x = texel_at(&v, 0, 90, wide), y = texel_at(&v, 1, -70, wide);
    image_view_zoom(&v, 1.5f, 90, -70, wide);
    assert_true(near((double)v.zoom, 3));
    assert_true(near((double)texel_at(&v, 0, 90, wide), (double)x));
    assert_true(near((double)texel_at(&v, 1, -70, wide), (double)y));
    assert_false(v.fit);
}

static void zoom_has_an_end(void **state) {
    (void)state;
    image_view v = {{0.5f, 0.5f}, 1, false};
    for (int i = 0; i < 100; i++) image_view_zoom(&v, 2, 30, 30, wide);
    float most = v.zoom, x = v.center[0];
    image_view_zoom(&v, 2, 300, 0, wide);
    assert_true(v.zoom == most && v.center[0] == x && isfinite(most));
    for (int i = 0; i < 100; i++) image_view_zoom(&v, 0.5f, 0, 0, wide);
    assert_true(v.zoom > 0);
}

static void another_level_shows_the_same_part(void **state) {
    (void)state;
    const roil_image_info bloom = {.size = {640, 360, 1}, .mips = 4};
    float before[2], after[2];
    image_view v = {{0.3f, 0.4f}, 1.5f, false};
    image_view_plane(&bloom, 0, 2, before);
    image_view_plane(&bloom, 2, 2, after);
    assert_true(after[0] == 160 && after[1] == 90);
    float seen = before[0] * v.zoom;
    image_view_level(&v, 2);
    assert_true(near((double)(after[0] * v.zoom), (double)seen));
    image_view_level(&v, -2);
    assert_true(v.zoom == 1.5f);
}

static void planes_of_a_volume(void **state) {
    (void)state;
    const roil_image_info smoke = {.size = {80, 60, 5}, .mips = 3, .volume = true};
    const float expected[3][2] = {{60, 5}, {80, 5}, {80, 60}};
    const uint32_t slices[3] = {80, 60, 5};
    for (int axis = 0; axis < 3; axis++) {
        float size[2];
        image_view_plane(&smoke, 0, axis, size);
        assert_true(size[0] == expected[axis][0] && size[1] == expected[axis][1]);
        assert_int_equal(image_view_slices(&smoke, 0, axis), slices[axis]);
    }
    assert_int_equal(image_view_slices(&smoke, 2, 2), 1);
    const roil_image_info flat = {.size = {80, 60, 1}, .mips = 1};
    float size[2];
    image_view_plane(&flat, 0, 0, size); // what is no volume has no axis
    assert_true(size[0] == 80 && size[1] == 60);
    assert_int_equal(image_view_slices(&flat, 0, 0), 1);
}

static void channels_by_format(void **state) {
    (void)state;
    assert_int_equal(image_channels("rgba16f"), 4);
    assert_int_equal(image_channels("rgba8_srgb"), 4);
    assert_int_equal(image_channels("rg32f"), 2);
    assert_int_equal(image_channels("r32ui"), 1);
    assert_int_equal(image_channels("d32f"), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_lie_from_left_to_right),
        cmocka_unit_test(what_is_beside_the_bar_is_its_end),
        cmocka_unit_test(a_bar_of_one_frame_or_no_width),
        cmocka_unit_test(ticks_are_round_and_far_apart),
        cmocka_unit_test(fit_shows_all_of_it),
        cmocka_unit_test(a_pan_moves_with_the_hand),
        cmocka_unit_test(zoom_keeps_what_is_under_the_pointer),
        cmocka_unit_test(zoom_has_an_end),
        cmocka_unit_test(another_level_shows_the_same_part),
        cmocka_unit_test(planes_of_a_volume),
        cmocka_unit_test(channels_by_format),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
