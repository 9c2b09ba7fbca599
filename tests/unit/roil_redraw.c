// Which parts of a window are drawn anew, and which triangles with them.
#include "base_test.h"

#include "base/memory.h"
#include "roil/view.h"
#include <math.h>
#include <string.h>

enum { WIDTH = 500, HEIGHT = 300, QUADS = 64, TILE = REDRAW_TILE };

typedef struct interface {
    roil_vertex vertices[4 * QUADS];
    uint32_t indices[6 * QUADS];
    roil_draw draws[QUADS];
    roil_picture picture;
    redraw_below below;
} interface;

static interface s;
static redraw d;

static void place(size_t i, float x, float y, float width, float height, uint32_t color) {
    static const uint32_t corners[] = {0, 1, 2, 2, 1, 3};
    for (uint32_t k = 0; k < 4; k++)
        s.vertices[4 * i + k] =
            (roil_vertex){x + (k & 1 ? width : 0), y + (k & 2 ? height : 0), 0, 0, color};
    for (uint32_t k = 0; k < 6; k++) s.indices[6 * i + k] = (uint32_t)(4 * i) + corners[k];
    s.draws[i] = (roil_draw){NULL, (uint32_t)(6 * i), 6, {0, 0, WIDTH, HEIGHT}};
    if (i < s.picture.draw_count) return;
    s.picture.draw_count = i + 1;
    s.picture.vertex_count = 4 * (i + 1);
    s.picture.index_count = 6 * (i + 1);
}

static int begin(void **state) {
    (void)state;
    memset(&s, 0, sizeof s);
    s.picture = (roil_picture){.width = WIDTH,
                               .height = HEIGHT,
                               .vertices = s.vertices,
                               .indices = s.indices,
                               .draws = s.draws};
    return 0;
}

static int end(void **state) {
    (void)state;
    redraw_free(&d);
    return 0;
}

static void find(void) {
    redraw_find(&d, &s.picture, &s.below);
    assert_true(d.area_count <= REDRAW_AREAS);
}

static void draw(void) {
    find();
    redraw_keep(&d);
}

static bool is_in(const gpu_area *a, uint32_t x, uint32_t y) {
    return x >= a->x && x < a->x + a->width && y >= a->y && y < a->y + a->height;
}

// Returns how many areas a pixel is in.
static int areas_at(uint32_t x, uint32_t y) {
    int count = 0;
    for (size_t i = 0; i < d.area_count; i++) count += is_in(&d.areas[i], x, y);
    return count;
}

static uint64_t pixels(void) {
    uint64_t sum = 0;
    for (size_t i = 0; i < d.area_count; i++) sum += (uint64_t)d.areas[i].width * d.areas[i].height;
    return sum;
}

static void expect_whole(void) {
    find();
    assert_int_equal(d.area_count, 1);
    assert_int_equal(pixels(), WIDTH * HEIGHT);
    redraw_keep(&d);
}

static void what_stays_is_left_alone(void **state) {
    (void)state;
    place(0, 10, 10, 50, 50, 1);
    expect_whole();
    assert_int_equal(d.draw_count, 1);
    assert_int_equal(d.index_count, 6);
    find();
    assert_int_equal(d.area_count, 0);
    assert_int_equal(d.draw_count, 0);
}

static void what_moves_is_drawn_where_it_was_and_where_it_is(void **state) {
    (void)state;
    place(0, 10, 10, 20, 20, 1);
    place(1, 300, 200, 20, 20, 2); // not near it
    draw();
    place(0, 400, 10, 20, 20, 1);
    find();
    assert_int_equal(d.area_count, 2);
    assert_int_equal(pixels(), 2 * TILE * TILE);
    assert_int_equal(areas_at(15, 15) + areas_at(410, 15), 2);
    assert_int_equal(d.draw_count, 1);
    assert_int_equal(d.draws[0].of, 0);
    redraw_keep(&d);
    find();
    assert_int_equal(d.area_count, 0);
}

static void all_that_a_look_depends_on_counts(void **state) {
    (void)state;
    roil_texture texture = {.version = 1};
    place(0, 10, 10, 20, 20, 1);
    place(1, 10, 10, 20, 20, 2); // over it
    draw();
    s.vertices[3].v = 0.5f;
    find();
    assert_int_equal(d.area_count, 1);
    assert_int_equal(d.draw_count, 2); // what lies over it, too
    redraw_keep(&d);
    s.draws[0].texture = &texture;
    find();
    assert_int_equal(d.area_count, 1);
    redraw_keep(&d);
    texture.version++;
    find();
    assert_int_equal(d.area_count, 1);
    redraw_keep(&d);
    s.draws[1].clip[2] = 20;
    find();
    assert_int_equal(d.area_count, 1);
    redraw_keep(&d);
    place(0, 10, 10, 20, 20, 2); // the same two in the other order
    place(1, 10, 10, 20, 20, 1);
    find();
    assert_int_equal(d.area_count, 1);
}

static void what_lies_below_counts_in_its_place(void **state) {
    (void)state;
    const int32_t wide[4] = {TILE + 8, 8, 2 * TILE, 40};
    memcpy(s.below.places[0], wide, sizeof wide);
    draw();
    s.below.pictures++;
    find();
    assert_int_equal(areas_at(TILE + 8, 8), 1);
    assert_int_equal(areas_at(3 * TILE + 7, 47), 1);
    assert_int_equal(areas_at(8, 8) + areas_at(TILE + 8, TILE), 0);
    redraw_keep(&d);
    s.below.ground++;
    expect_whole();
    s.picture.width--;
    find();
    assert_int_equal(pixels(), (WIDTH - 1) * HEIGHT);
}

static void what_was_not_drawn_is_found_again(void **state) {
    (void)state;
    place(0, 10, 10, 20, 20, 1);
    draw();
    find(); // and the device failed
    expect_whole();
    redraw_forget(&d);
    expect_whole();
}

// Of many changes areas are made that are few, and have no pixel twice.
static void areas_never_overlap(void **state) {
    (void)state;
    uint32_t random = 1;
    for (size_t i = 0; i < QUADS; i++) place(i, 0, 0, 1, 1, 0);
    draw();
    for (int round = 0; round < 200; round++) {
        uint32_t at[QUADS][2], count = 1 + (uint32_t)round % 40;
        for (size_t i = 0; i < count; i++) {
            random = random * 1664525 + 1013904223;
            at[i][0] = (random >> 8) % (WIDTH - 4);
            at[i][1] = (random >> 20) % (HEIGHT - 4);
            place(i, (float)at[i][0], (float)at[i][1], 4, 4, (uint32_t)round);
        }
        find();
        for (size_t i = 0; i < count; i++) assert_int_equal(areas_at(at[i][0], at[i][1]), 1);
        for (uint32_t y = 0; y < HEIGHT; y += 7)
            for (uint32_t x = 0; x < WIDTH; x += 7) assert_true(areas_at(x, y) < 2);
        redraw_keep(&d);
    }
}

// A triangle is in the list of each area that it reaches, cut to it, in the order of the picture.
static void triangles_are_cut_to_areas(void **state) {
    (void)state;
    place(0, 0, 0, WIDTH, HEIGHT, 1); // behind all
    place(1, 10, 10, 20, 20, 1);
    place(2, 400, 200, 20, 20, 1);
    draw();
    place(1, 10, 10, 20, 20, 2);
    place(2, 400, 200, 20, 20, 2);
    find();
    assert_int_equal(d.area_count, 2);
    assert_int_equal(d.draw_count, 4);
    for (size_t i = 0; i < d.draw_count; i++) {
        const redraw_draw *draw = &d.draws[i];
        assert_int_equal(draw->of, i % 2 ? 1 + i / 2 : 0);
        assert_true(draw->count == 3 || draw->count == 6);
        for (uint32_t k = 0; k < draw->count; k++)
            assert_int_equal(d.indices[draw->first + k] / 4, draw->of);
        assert_int_equal(areas_at(draw->area.x, draw->area.y), 1);
        assert_true(draw->area.width <= TILE && draw->area.height <= TILE);
    }
}

static void strange_numbers_do_no_harm(void **state) {
    (void)state;
    place(0, -1e30f, -5, 2e30f, 10, 1);
    place(1, NAN, 10, INFINITY, 20, 1);
    place(2, -50, -50, 20, 20, 1); // outside
    s.draws[1].clip[0] = NAN;
    draw();
    place(0, -1e30f, -5, 2e30f, 10, 2);
    place(2, WIDTH + TILE, HEIGHT + TILE, 20, 20, 1);
    find();
    assert_int_equal(d.area_count, 1);
    assert_int_equal(pixels(), WIDTH * TILE);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_stays_is_left_alone, begin, end),
        cmocka_unit_test_setup_teardown(what_moves_is_drawn_where_it_was_and_where_it_is, begin,
                                        end),
        cmocka_unit_test_setup_teardown(all_that_a_look_depends_on_counts, begin, end),
        cmocka_unit_test_setup_teardown(what_lies_below_counts_in_its_place, begin, end),
        cmocka_unit_test_setup_teardown(what_was_not_drawn_is_found_again, begin, end),
        cmocka_unit_test_setup_teardown(areas_never_overlap, begin, end),
        cmocka_unit_test_setup_teardown(triangles_are_cut_to_areas, begin, end),
        cmocka_unit_test_setup_teardown(strange_numbers_do_no_harm, begin, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
