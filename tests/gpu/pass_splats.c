// What splats add to a picture: as much light as they have, whatever their place, size and order.
#include "splats_test.h"

static const double area = 3.14159265358979 / 3; // of a round one, in squares of the radius

// Of radius `pixels`, and light 10 in its middle.
static void open_round(spots *s, gpu *device, uint32_t count, float pixels) {
    spots_open(s, device, count);
    spots_field(s, "size", number(&s->w, 2 * pixels / METRE));
    spots_field(s, "color", triple(&s->w, 10, 5, 0));
}

static void light_is_kept_wherever_a_splat_lies(void **state) {
    static const struct {
        float radius;
        double slack;
    } kinds[] = {{0.2f, 0.01}, {0.95f, 0.001}, {1.05f, 0.03}, {3, 0.01}, {12, 0.002}};
    for (size_t i = 0; i < COUNT_OF(kinds); i++) {
        spots s;
        double wanted = 10 * area * (double)(kinds[i].radius * kinds[i].radius);
        open_round(&s, *state, 1, kinds[i].radius);
        spots_build(&s);
        for (int k = 0; k < 9; k++) {
            spot one = {.at = {(0.37f * (float)k - 1) / METRE, 0, 0.23f * (float)k / METRE}};
            float *pixels = spots_draw(&s, &one);
            is_near(sum_of(pixels, 0), wanted, kinds[i].slack * wanted, "red");
            is_near(sum_of(pixels, 1), 0.5 * wanted, kinds[i].slack * wanted, "green");
            assert_true(sum_of(pixels, 2) == 0 && sum_of(pixels, 3) == 0);
            mem_free(pixels);
        }
        spots_close(&s);
    }
}

// Of all sizes: added to pixels, and listed, where that begins late, too.
static void scatter(spot *list, uint32_t count) {
    uint32_t seed = 5;
    for (uint32_t i = 0; i < count; i++) {
        list[i] = (spot){.lifetime = 1};
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525 + 1013904223;
            list[i].at[k] = ((float)(seed >> 8) / (1 << 24) - 0.5f) * 1.2f;
            list[i].age = (float)(seed >> 8) / (1 << 24) * 0.99f;
        }
        list[i].moves[0] = 4 * (list[i].age - 0.5f);
    }
}

static void open_scattered(spots *s, gpu *device, uint32_t count, const char *blend) {
    spots_open(s, device, count);
    const field *age = field_make(&s->w.memory, "particle_age", NULL, NULL);
    const field *square = row(&s->w, "mul", SET("a", age), SET("b", age));
    spots_field(s, "size", row(&s->w, "mul", SET("a", square), SET("b", number(&s->w, 2.5f))));
    const field *color =
        row(&s->w, "vec", SET("x", age), SET("y", number(&s->w, 0.5f)), SET("z", square));
    spots_field(s, "color", color);
    spots_field(s, "opacity", number(&s->w, 0.6f));
    spots_set(s, "streak", 0.1f);
    spots_blend(s, blend);
}

static float *draw_scattered(gpu *device, const char *blend, const char *entries, bool reversed) {
    enum { COUNT = 400 };
    static spot list[COUNT], other[COUNT];
    spots s;
    open_scattered(&s, device, COUNT, blend);
    gpu_test_ok(pass_set_option(s.splats, "entries", entries));
    spots_build(&s);
    scatter(list, COUNT);
    for (int i = 0; i < COUNT; i++) other[i] = list[reversed ? COUNT - 1 - i : i];
    float *pixels = spots_draw(&s, other);
    spots_close(&s);
    return pixels;
}

static void order_changes_nothing(void **state) {
    static const char *const blends[] = {"additive", "weighted"};
    for (size_t i = 0; i < COUNT_OF(blends); i++) {
        float *one = draw_scattered(*state, blends[i], "8", false);
        float *other = draw_scattered(*state, blends[i], "8", true);
        assert_true(sum_of(one, 0) > 10);
        assert_memory_equal(one, other, 4 * SIDE * SIDE * sizeof *one);
        mem_free(one);
        mem_free(other);
    }
}

static void nothing_is_lost_where_lists_are_full(void **state) {
    float *one = draw_scattered(*state, "additive", "32", false);
    float *other = draw_scattered(*state, "additive", "1", false);
    assert_memory_equal(one, other, 4 * SIDE * SIDE * sizeof *one);
    mem_free(one);
    mem_free(other);
}

static void the_dead_and_those_outside_are_not_drawn(void **state) {
    spots s;
    open_round(&s, *state, 6, 2);
    spots_build(&s);
    static const spot none[6] = {{.age = 2, .lifetime = 1}, {.age = -1, .lifetime = 1},
                                 {.at = {0, -6, 0}},        {.at = {9, 0, 0}},
                                 {.at = {NAN, 0, 0}},       {.at = {0, INFINITY, 0}}};
    float *pixels = spots_draw(&s, none);
    assert_true(sum_of(pixels, 0) == 0);
    mem_free(pixels);
    spots_close(&s);
}

// ---- opacity ----------------------------------------------------------------------------------

typedef struct disc { // as the shader sees one
    double x, y, depth, radius, opacity;
    float color[3];
} disc;

static int by_depth(const void *a, const void *b) {
    double x = ((const disc *)a)->depth, y = ((const disc *)b)->depth;
    return (x > y) - (x < y);
}

// Where a thing lies in the picture, of a radius in metres.
static disc disc_of(const spot *p, double metres, double opacity) {
    double depth = (double)p->at[1] + 5, scale = METRE * 5 / depth;
    double own = metres * scale, radius = sqrt(own * own + 1.5 * 1.5);
    return (disc){
        .x = SIDE / 2 + (double)p->at[0] * scale,
        .y = SIDE / 2 - (double)p->at[2] * scale,
        .depth = depth,
        .radius = radius,
        .opacity = opacity * own * own / (radius * radius),
    };
}

static void compose(const disc *list, int count, int x, int y, double out[4]) {
    double through = 1;
    memset(out, 0, 4 * sizeof *out);
    for (int i = 0; i < count; i++) {
        double dx = x + 0.5 - list[i].x, dy = y + 0.5 - list[i].y;
        double rest = fmax(1 - (dx * dx + dy * dy) / (list[i].radius * list[i].radius), 0);
        double covered = list[i].opacity * rest * rest;
        for (int k = 0; k < 3; k++) out[k] += through * covered * (double)list[i].color[k];
        through *= 1 - covered;
    }
    out[3] = 1 - through;
}

static void sorted_is_what_a_sum_by_hand_gives(void **state) {
    enum { COUNT = 90 };
    static spot list[COUNT];
    static disc discs[COUNT];
    spots s;
    spots_open(&s, *state, COUNT);
    spots_field(&s, "size", number(&s.w, 0.5f));
    spots_field(&s, "opacity", number(&s.w, 0.8f));
    const field *age = field_make(&s.w.memory, "particle_age", NULL, NULL);
    spots_field(&s, "color", row(&s.w, "vec", SET("x", age), SET("y", number(&s.w, 0.5f))));
    spots_blend(&s, "sorted");
    gpu_test_ok(pass_set_option(s.splats, "entries", "32"));
    spots_build(&s);
    scatter(list, COUNT);
    for (int i = 0; i < COUNT; i++) {
        memset(list[i].moves, 0, sizeof list[i].moves);
        discs[i] = disc_of(&list[i], 0.25, 0.8);
        discs[i].color[0] = list[i].age;
        discs[i].color[1] = 0.5f;
    }
    qsort(discs, COUNT, sizeof *discs, by_depth);
    float *pixels = spots_draw(&s, list);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double wanted[4];
            compose(discs, COUNT, x, y, wanted);
            for (int k = 0; k < 4; k++)
                is_near((double)pixel_at(pixels, x, y)[k], wanted[k], 3e-3, "sorted");
        }
    assert_true(pixel_at(pixels, SIDE / 2, SIDE / 2)[3] > 0.9f);
    mem_free(pixels);
    spots_close(&s);
}

// One alone hides as it says; of two in one place both count; a far one hardly does.
static void weighted_is_a_mean_by_opacity(void **state) {
    spots s;
    spots_open(&s, *state, 2);
    spots_field(&s, "size", number(&s.w, 1));
    spots_field(&s, "opacity", number(&s.w, 0.5f));
    const field *age = field_make(&s.w.memory, "particle_age", NULL, NULL);
    spots_field(&s, "color", row(&s.w, "vec", SET("x", age), SET("y", number(&s.w, 1))));
    spots_blend(&s, "weighted");
    spots_build(&s);
    const float half_pixel = 0.5f / METRE;
    spot list[2] = {{.at = {half_pixel, 0, -half_pixel}, .age = 2, .lifetime = 10}, {.age = -1}};
    list[1].lifetime = 10;
    float *pixels = spots_draw(&s, list);
    const float *middle = pixel_at(pixels, SIDE / 2, SIDE / 2);
    double covers = 0.5 * 256 / (256 + 2.25); // of a radius of 16 pixels
    is_near((double)middle[3], covers, 3e-3, "opacity of one");
    is_near((double)middle[0], 0.2 * covers, 3e-3, "colour of one");
    mem_free(pixels);
    list[1] = list[0];
    list[1].age = 8;
    pixels = spots_draw(&s, list);
    middle = pixel_at(pixels, SIDE / 2, SIDE / 2);
    double both = 1 - (1 - covers) * (1 - covers);
    is_near((double)middle[3], both, 3e-3, "opacity of two");
    is_near((double)middle[0], 0.5 * both, 5e-3, "colour of two");
    mem_free(pixels);
    list[1].at[1] = 20; // 25 m away, of 5
    list[1].at[0] *= 5, list[1].at[2] *= 5;
    pixels = spots_draw(&s, list);
    middle = pixel_at(pixels, SIDE / 2, SIDE / 2);
    assert_true(middle[3] > 0.6f && middle[0] < 0.22f * middle[3]);
    mem_free(pixels);
    spots_close(&s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_kept_wherever_a_splat_lies),
        cmocka_unit_test(order_changes_nothing),
        cmocka_unit_test(nothing_is_lost_where_lists_are_full),
        cmocka_unit_test(the_dead_and_those_outside_are_not_drawn),
        cmocka_unit_test(sorted_is_what_a_sum_by_hand_gives),
        cmocka_unit_test(weighted_is_a_mean_by_opacity),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
