// Templates of a flow, where they are and how they are drawn, without what the flow makes of them
// (pass_slices_templates_flow.c).
#include "templates_test.h"

static const double pi = 3.14159265358979;
static const flow_desc small = {.size = {64, 64}, .slices = 2};
static const float blue[4] = {0, 0, 1, 1}, red[4] = {1, 0, 0, 1};

typedef struct group_of { // settings of a group by name
    const char *name;
    float value;
} group_of;

// Pictures without alpha, whose border fades.
static pass *add_group(templates_world *t, uint32_t count, picture image, const group_of *settings,
                       size_t setting_count) {
    picture *kept = arena_alloc(&t->w.memory, sizeof *kept);
    *kept = image;
    pass *p = templates_add(t, kept, count);
    for (size_t i = 0; i < setting_count; i++)
        templates_set(t, p, settings[i].name, settings[i].value);
    return p;
}

#define GROUP(t, count, color, ...)                                                                \
    add_group(t, count, templates_picture(&(t)->w.memory, color), (const group_of[]){__VA_ARGS__}, \
              COUNT_OF(((const group_of[]){__VA_ARGS__})))

static void set_word(pass *p, const char *name, const char *word) {
    gpu_test_ok(pass_set_option(p, name, word));
}

// A ball cut by the slice: a disc.
static const field *disc(templates_world *t, float x, float y, float radius, float falloff) {
    return row(&t->w, "sphere", SET("position", triple(&t->w, x, y, 0)),
               SET("radius", number(&t->w, radius)), SET("falloff", number(&t->w, falloff)));
}

// ---- lives ------------------------------------------------------------------------------------

// Lives are as likely at all lengths, and templates of all sizes between their bounds. Over many
// lives, of which each counts once.
static void sizes_and_lifetimes_are_spread_evenly_between_their_bounds(void **state) {
    enum { COUNT = 200, STEPS = 60, BINS = 8 };
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    GROUP(&t, COUNT, blue, {"size_min", 0.1f}, {"size_max", 0.3f}, {"lifetime_min", 0.05f},
          {"lifetime_max", 0.25f});
    templates_build(&t);
    int sizes[BINS] = {0}, lifetimes[BINS] = {0}, lives = 0;
    float last[COUNT] = {0};
    for (int k = 0; k < STEPS / 3; k++) {
        templates_run(&t, 3, false);
        template_seen *seen = templates_read(&t, 0);
        for (int i = 0; i < COUNT; i++) {
            const template_seen *s = &seen[i];
            assert_true(s->side >= 0.1f && s->side < 0.3f);
            assert_true(s->lifetime >= 0.05f && s->lifetime < 0.25f);
            assert_true(s->age >= 0 && s->age < s->lifetime + 1e-5f);
            assert_true(fabsf(s->half_side - 32 * s->side) < 1e-4f);
            if (s->life == last[i]) continue;
            last[i] = s->life;
            sizes[(int)((s->side - 0.1f) / 0.2f * BINS)]++;
            lifetimes[(int)((s->lifetime - 0.05f) / 0.2f * BINS)]++;
            lives++;
        }
        mem_free(seen);
    }
    double size_misfit = 0, life_misfit = 0, each = (double)lives / BINS;
    for (int b = 0; b < BINS; b++) {
        size_misfit += (sizes[b] - each) * (sizes[b] - each) / each;
        life_misfit += (lifetimes[b] - each) * (lifetimes[b] - each) / each;
    }
    print_message("%d lives; chi-squared of sizes %.1f, of lifetimes %.1f\n", lives, size_misfit,
                  life_misfit);
    assert_true(lives > 1000);
    assert_true(size_misfit < 24.3 && life_misfit < 24.3); // 7 degrees of freedom: 1 in 1000
    templates_close(&t);
}

static void same_seed_gives_the_same_templates_and_another_one_others(void **state) {
    template_seen *seen[3];
    static const float seeds[3] = {5, 5, 6};
    for (int k = 0; k < 3; k++) {
        templates_world t;
        templates_open(&t, *state, &small, 0.02);
        GROUP(&t, 50, blue, {"seed", seeds[k]});
        GROUP(&t, 30, red, {"seed", seeds[k]});
        templates_build(&t);
        // In frames of one step, and of twenty.
        if (k == 0)
            for (int i = 0; i < 40; i++) templates_run(&t, 1, false);
        else
            templates_run(&t, 40, false);
        seen[k] = templates_read(&t, 1);
        templates_close(&t);
    }
    assert_memory_equal(seen[0], seen[1], 80 * sizeof **seen);
    assert_memory_not_equal(seen[0], seen[2], 80 * sizeof **seen);
    assert_memory_not_equal(seen[0], seen[0] + 50, 30 * sizeof **seen);
    for (int k = 0; k < 3; k++) mem_free(seen[k]);
}

// Half as long steps: after the same time the same lives, up to what a step is late by.
static void lives_do_not_hang_on_the_step(void **state) {
    template_seen *seen[2];
    for (int k = 0; k < 2; k++) {
        templates_world t;
        templates_open(&t, *state, &small, k == 0 ? 0.02 : 0.01);
        GROUP(&t, 100, blue, {"lifetime_min", 0.3f}, {"lifetime_max", 0.6f});
        templates_build(&t);
        templates_run(&t, k == 0 ? 50 : 100, false);
        seen[k] = templates_read(&t, 0);
        templates_close(&t);
    }
    int same = 0;
    for (int i = 0; i < 100; i++)
        same += seen[0][i].life == seen[1][i].life && seen[0][i].x == seen[1][i].x;
    assert_true(same >= 95); // others are just about to begin anew
    for (int k = 0; k < 2; k++) mem_free(seen[k]);
}

static void slices_have_templates_of_their_own(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    GROUP(&t, 20, blue, {"strength", 1});
    templates_build(&t);
    templates_run(&t, 1, false);
    template_seen *first = templates_read(&t, 0), *second = templates_read(&t, 1);
    for (int i = 0; i < 20; i++) assert_true(first[i].x != second[i].x);
    mem_free(first);
    mem_free(second);
    templates_close(&t);
}

// As a reload does: the new flow goes on with the instances of the old one, where they match.
static void instances_are_exchanged_where_they_match(void **state) {
    static const uint32_t counts[2] = {20, 21};
    for (int k = 0; k < 2; k++) {
        templates_world a, b;
        templates_open(&a, *state, &small, 0.02);
        templates_open(&b, *state, &small, 0.02);
        GROUP(&a, 20, blue, {"strength", 1});
        GROUP(&b, counts[k], blue, {"strength", 2});
        templates_build(&a);
        templates_build(&b);
        templates_run(&a, 5, false);
        template_seen *old = templates_read(&a, 0);
        template_set_exchange(&b.f.templates->set, &a.f.templates->set);
        templates_run(&b, 1, false);
        template_seen *now = templates_read(&b, 0);
        int same = 0;
        for (int i = 0; i < 20; i++)
            same += now[i].x == old[i].x && fabsf(now[i].age - old[i].age - 0.02f) < 1e-5f;
        assert_true(k == 0 ? same > 10 : same == 0);
        mem_free(old);
        mem_free(now);
        templates_close(&a);
        templates_close(&b);
    }
}

static void fewer_act_by_amount(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    pass *p = GROUP(&t, 20, blue, {"amount", 0.25f});
    templates_build(&t);
    for (int k = 0; k < 2; k++) {
        templates_run(&t, 1, false);
        template_seen *seen = templates_read(&t, 0);
        int acting = 0;
        for (int i = 0; i < 20; i++) acting += seen[i].half_side > 0;
        assert_int_equal(acting, k == 0 ? 5 : 0);
        mem_free(seen);
        templates_set(&t, p, "amount", 0);
    }
    templates_close(&t);
}

// ---- places -----------------------------------------------------------------------------------

static void all_lie_in_the_region_and_all_over_it(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    pass *p = GROUP(&t, 400, blue, {"strength", 1});
    gpu_test_ok(pass_set_field(p, "region", disc(&t, 0.3f, 0.6f, 0.2f, 0)));
    templates_build(&t);
    templates_run(&t, 1, false);
    template_seen *seen = templates_read(&t, 0);
    int inner = 0, left = 0;
    for (int i = 0; i < 400; i++) {
        float x = seen[i].x / 64 - 0.3f, y = seen[i].y / 64 - 0.6f, r = sqrtf(x * x + y * y);
        assert_true(seen[i].put == 1 && r <= 0.2001f);
        inner += r < 0.2f * sqrtf(0.5f);
        left += x < 0;
    }
    assert_true(abs(inner - 200) < 50 && abs(left - 200) < 50); // five standard deviations
    mem_free(seen);
    templates_close(&t);
}

// A region that is nowhere: none is put, and none is drawn, until it is somewhere.
static void none_is_put_where_there_is_no_place(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    pass *p = GROUP(&t, 10, blue, {"strength", 1});
    const field *factors[FIELD_MAX_ARGS] = {disc(&t, 0.5f, 0.5f, 0.2f, 0),
                                            field_param(&t.w.memory, 1, 0)};
    float value[1][4] = {{0}};
    t.w.context.params = value;
    t.w.context.param_count = 1;
    gpu_test_ok(pass_set_field(p, "region", field_make(&t.w.memory, "mul", factors, NULL)));
    templates_build(&t);
    for (int k = 0; k < 2; k++) {
        templates_run(&t, 3, false);
        template_seen *seen = templates_read(&t, 0);
        for (int i = 0; i < 10; i++) assert_true((seen[i].half_side > 0) == (k == 1));
        mem_free(seen);
        value[0][0] = 1;
    }
    templates_close(&t);
}

// ---- turns ------------------------------------------------------------------------------------

// How far the upper edge looks away from `x, y`: 1 straight away, -1 straight towards it.
static float outward(const template_seen *s, float x, float y) {
    float dx = s->x - x, dy = s->y - y, r = sqrtf(dx * dx + dy * dy);
    return (-s->sine * dx + s->cosine * dy) / r;
}

static void align_turns_the_upper_edge(void **state) {
    static const char *const words[] = {"fixed", "radial", "contour", "none"};
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    pass *groups[4];
    for (int k = 0; k < 4; k++) {
        groups[k] = GROUP(&t, 64, blue, {"size_min", 0.1f}, {"size_max", 0.2f}, {"center_x", 0.2f},
                          {"center_y", 0.9f});
        set_word(groups[k], "align", words[k]);
        gpu_test_ok(pass_set_field(groups[k], "region", disc(&t, 0.5f, 0.4f, 0.3f, 0)));
    }
    templates_set(&t, groups[0], "angle", 30);
    templates_build(&t);
    templates_run(&t, 1, false);
    template_seen *seen = templates_read(&t, 0);
    const float least = gpu_test_is_coarse() ? 0.9995f : 0.9999f;
    double worst = 1, mean = 0, any[2] = {0, 0};
    for (int i = 0; i < 64; i++) {
        assert_true(fabsf(seen[i].cosine - cosf((float)pi / 6)) < 1e-5f);
        assert_true(fabsf(seen[i].sine - 0.5f) < 1e-5f);
        assert_true(outward(&seen[64 + i], 0.2f * 64, 0.9f * 64) > least);
        double out = (double)outward(&seen[128 + i], 32, 0.4f * 64); // the contour is a circle
        worst = fmin(worst, out), mean += out / 64;
        any[0] += (double)seen[192 + i].cosine, any[1] += (double)seen[192 + i].sine;
    }
    print_message("out of a disc: mean cosine %.4f, worst %.3f\n", mean, worst);
    assert_true(mean > 0.97 && worst > 0.6);
    assert_true(hypot(any[0], any[1]) < 24); // of 64 that look anywhere: three deviations
    mem_free(seen);
    templates_close(&t);
}

static void spread_turns_each_by_less_than_it_says(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    set_word(GROUP(&t, 64, blue, {"spread", 20}), "align", "fixed");
    templates_build(&t);
    templates_run(&t, 1, false);
    template_seen *seen = templates_read(&t, 0);
    float least = 1, most = -1;
    for (int i = 0; i < 64; i++)
        least = fminf(least, seen[i].sine), most = fmaxf(most, seen[i].sine);
    assert_true(most <= sinf(20 * (float)pi / 180) + 1e-5f && most > 0.25f);
    assert_true(least >= -sinf(20 * (float)pi / 180) - 1e-5f && least < -0.25f);
    mem_free(seen);
    templates_close(&t);
}

// ---- drawing ----------------------------------------------------------------------------------

// One of 32 cells in the middle of a slice of 64, at a given turn, that does not come and go and is
// blended in by all of its alpha.
static pass *add_one(templates_world *t, picture image, float angle) {
    static const group_of settings[] = {
        {"size_min", 0.5f}, {"size_max", 0.5f}, {"fade", 0}, {"strength", 3}, {"blend", 1}};
    pass *p = add_group(t, 1, image, settings, COUNT_OF(settings));
    templates_set(t, p, "angle", angle);
    set_word(p, "align", "fixed");
    gpu_test_ok(pass_set_field(p, "region", disc(t, 0.5f, 0.5f, 1e-4f, 0)));
    return p;
}

// What is drawn for an alpha of 128 cells and 60 steps a second, with 64 cells and 50 steps.
static const double firmer = 0.25 * 60 / 50;
static double alpha_of_64(double alpha) {
    return alpha / (alpha + (1 - alpha) * firmer);
}

// Alpha is 1 in the middle and nearly 0 at the border (K21), the pressure as strong as it says.
static void border_fades_as_a_gaussian(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    add_one(&t, templates_picture(&t.w.memory, blue), 0);
    templates_build(&t);
    templates_run(&t, 1, false);
    float *drawn = templates_read_flow(&t, "FlowTemplates");
    double worst = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            double u = (x + 0.5 - 32) / 16, v = (y + 0.5 - 32) / 16;
            bool inside = fabs(u) < 1 && fabs(v) < 1;
            double alpha = inside ? exp(-0.5 * (u * u + v * v) / 0.09) : 0;
            const float *cell = drawn + 2 * (64 * y + x);
            double seen = (double)cell[0], drawn_alpha = firmer * seen / (1 - (1 - firmer) * seen);
            worst = fmax(worst, fabs(drawn_alpha - alpha));
            if (inside && alpha > 1e-3) assert_true(fabsf(cell[1] - 3) < 0.01f);
        }
    print_message("alpha is off by %.4f at most\n", worst);
    assert_true(worst < 0.02);
    assert_true(drawn[2 * (64 * 32 + 32)] > 0.99f && drawn[2 * (64 * 32 + 16)] < 0.024f);
    mem_free(drawn);
    templates_close(&t);
}

// The picture's lower left quarter is red: it lands where the turn brings it, and its velocity
// turns with it.
static void pictures_and_velocities_turn_together(void **state) {
    enum { SIDE = 16 };
    float texels[SIDE * SIDE * 4] = {0};
    for (int y = 0; y < SIDE; y++) // rows from the top
        for (int x = 0; x < SIDE; x++) {
            texels[4 * (y * SIDE + x)] = x < SIDE / 2 && y >= SIDE / 2;
            texels[4 * (y * SIDE + x) + 3] = x < SIDE / 2 && y >= SIDE / 2;
        }
    const picture quarter = {SIDE, SIDE, 0, texels};
    static const int turned[4][2] = {{24, 24}, {40, 24}, {40, 40}, {24, 40}}; // anticlockwise
    static const float way[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int k = 0; k < 4; k++) {
        templates_world t;
        templates_open(&t, *state, &small, 0.02);
        pass *p = add_one(&t, quarter, 90.0f * (float)k);
        set_word(p, "kind", "velocity");
        templates_build(&t);
        templates_run(&t, 2, false); // what is written stays as it is
        float *drawn = templates_read_flow(&t, "FlowSources");
        for (int i = 0; i < 4; i++) {
            const float *push = drawn + 12 * (64 * turned[i][1] + turned[i][0]) + 8;
            for (int c = 0; c < 2; c++)
                assert_true(fabsf(push[c] - (i == k ? 3 * 0.02f * way[k][c] : 0)) < 1e-3f);
        }
        mem_free(drawn);
        templates_close(&t);
    }
}

// Two that overlap: the later one is blended over the earlier one, and both kinds are drawn at
// once.
static void groups_of_both_kinds_are_drawn_over_each_other(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    templates_set(&t, add_one(&t, templates_picture(&t.w.memory, blue), 0), "blend", 0.5f);
    templates_set(&t, add_one(&t, templates_picture(&t.w.memory, blue), 0), "strength", -3);
    set_word(add_one(&t, templates_picture(&t.w.memory, red), 0), "kind", "velocity");
    templates_set(&t, t.groups[1], "blend", 0.5f);
    templates_build(&t);
    templates_run(&t, 1, false);
    float *pressed = templates_read_flow(&t, "FlowTemplates");
    float *pushed = templates_read_flow(&t, "FlowSources");
    const float *middle = pressed + 2 * (64 * 32 + 32);
    double one = alpha_of_64(0.5), first = one * (1 - one), both = first + one;
    assert_true(fabs((double)middle[0] - both) < 0.01);
    assert_true(fabs((double)middle[1] - (first * 3 - one * 3) / both) < 0.03);
    assert_true(fabsf(pushed[12 * (64 * 32 + 32) + 8] - 0.06f) < 1e-3f);
    mem_free(pressed);
    mem_free(pushed);
    templates_close(&t);
}

// Alpha of all instances of a slice in a cell, one blended over the other.
static double alpha_at(const template_seen *seen, uint32_t count, int x, int y) {
    double out = 0;
    for (uint32_t i = 0; i < count; i++) {
        const template_seen *s = &seen[i];
        if (s->half_side <= 0) continue;
        double dx = (x + 0.5 - (double)s->x) / (double)s->half_side;
        double dy = (y + 0.5 - (double)s->y) / (double)s->half_side;
        double u = (double)s->cosine * dx + (double)s->sine * dy;
        double v = (double)s->cosine * dy - (double)s->sine * dx;
        if (fabs(u) > 1 || fabs(v) > 1) continue;
        double alpha = (double)s->alpha * exp(-0.5 * (u * u + v * v) / 0.09);
        out = 1 - (1 - out) * (1 - alpha_of_64(alpha));
    }
    return out;
}

// Templates of all sizes, across tiles and beyond the slice, are where their instances are, in the
// first step and in later ones.
static void what_reaches_a_cell_is_drawn_there(void **state) {
    static const flow_desc oblong = {.size = {64, 48}, .slices = 2};
    templates_world t;
    templates_open(&t, *state, &oblong, 0.02);
    GROUP(&t, 30, blue, {"size_min", 0.15f}, {"size_max", 0.25f}, {"blend", 0.3f});
    GROUP(&t, 10, blue, {"size_min", 0.3f}, {"size_max", 1.5f}, {"blend", 0.02f});
    templates_build(&t);
    double worst = 0, sum = 0;
    for (int k = 0; k < 3; k++) {
        templates_run(&t, k + 1, false);
        float *drawn = templates_read_flow(&t, "FlowTemplates");
        for (int slice = 0; slice < 2; slice++) {
            template_seen *seen = templates_read(&t, (uint32_t)slice);
            for (int i = 0; i < 64 * 48; i++) {
                double alpha = alpha_at(seen, 40, i % 64, i / 64);
                worst = fmax(worst, fabs(alpha - (double)drawn[2 * (64 * 48 * slice + i)]));
                sum += alpha;
            }
            mem_free(seen);
        }
        mem_free(drawn);
    }
    print_message("alpha of 40 is off by %.4f at most, mean %.3f\n", worst, sum / (6 * 64 * 48));
    assert_true(worst < 0.06); // small ones are sampled on coarse levels
    assert_true(sum / (6 * 64 * 48) > 0.1);
    templates_close(&t);
}

static void they_come_and_go_by_fade(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.01);
    GROUP(&t, 200, blue, {"fade", 0.25f}, {"blend", 1}, {"lifetime_min", 1}, {"lifetime_max", 1});
    templates_build(&t);
    templates_run(&t, 1, false);
    template_seen *seen = templates_read(&t, 0);
    for (int i = 0; i < 200; i++) {
        float age = fminf(seen[i].age, 1 - seen[i].age) / 0.25f;
        float expected = age >= 1 ? 1 : age * age * (3 - 2 * age);
        assert_true(fabsf(seen[i].alpha - expected) < 1e-4f);
    }
    mem_free(seen);
    templates_close(&t);
}

// ---- by hand ----------------------------------------------------------------------------------

static float drawn_at(templates_world *t, const char *slot, int stride, int channel, int slice) {
    float *values = templates_read_flow(t, slot);
    float out = values[(size_t)stride * (size_t)(64 * 64 * slice + 64 * 32 + 32) + (size_t)channel];
    mem_free(values);
    return out;
}

// Put into one slice, or all, for as long as it says, besides a group or alone.
static void one_is_put_by_hand_and_goes_again(void **state) {
    for (int groups = 0; groups < 2; groups++) {
        templates_world t;
        templates_open(&t, *state, &small, 0.02);
        if (groups) GROUP(&t, 3, red, {"amount", 0});
        slices_take_hand(t.f.pass);
        templates_build(&t);
        picture image = templates_picture(&t.w.memory, blue);
        slices_hand pressed = {&image, false, 1, {0.5f, 0.5f}, 0.4f, 0, 3, 1, 0.05};
        slices_hand pushed = {NULL, true, SLICES_ALL, {0.5f, 0.5f}, 0.4f, 90, 2, 1, 0};
        gpu_test_ok(slices_put(t.f.pass, &pressed) && slices_put(t.f.pass, &pushed));
        for (int step = 0; step < 4; step++) {
            templates_run(&t, 1, false);
            for (int slice = 0; slice < 2; slice++) {
                bool there = slice == 1 && step < 3; // 0.05 s are two and a half steps
                float pressure = drawn_at(&t, "FlowTemplates", 2, 1, slice);
                assert_true(fabsf(pressure - (there ? 3 : 0)) < 0.02f);
                float left = drawn_at(&t, "FlowSources", 12, 8, slice);
                assert_true(fabsf(left - (step == 0 ? -2 * 0.02f : 0)) < 2e-3f);
            }
        }
        templates_close(&t);
    }
}

static void hand_makes_room_for_the_newest(void **state) {
    templates_world t;
    templates_open(&t, *state, &small, 0.02);
    slices_hand push = {NULL, true, SLICES_ALL, {0.1f, 0.1f}, 0.4f, 0, 2, 1, 10};
    GROUP(&t, 1, red, {"amount", 0});
    assert_false(slices_put(t.f.pass, &push)); // not made ready
    slices_take_hand(t.f.pass);
    templates_build(&t);
    for (int i = 0; i < 2 * SLICES_HAND_MOST; i++) gpu_test_ok(slices_put(t.f.pass, &push));
    push.place[0] = push.place[1] = 0.5f;
    gpu_test_ok(slices_put(t.f.pass, &push));
    templates_run(&t, 1, false);
    assert_true(drawn_at(&t, "FlowSources", 12, 9, 0) > 0.03f);
    templates_close(&t);
}

static void line_for_the_file_says_it_all(void **state) {
    (void)state;
    strbuf line = {0};
    slices_hand hand = {NULL, false, 0, {0.25f, 1.5f}, 0.1f, -30, 4, 0.5f, 0.2};
    slices_hand_line(&hand, "flow", "templates/mine.exr", &line);
    assert_string_equal(strbuf_text(&line),
                        "flow:templates { image \"templates/mine.exr\", kind = \"pressure\", "
                        "count = 1, region = disc { 0.25, 1.5, radius = 0.005 }, size = 0.1, "
                        "align = \"fixed\", angle = -30, strength = 4, blend = 0.5, "
                        "lifetime = 0.2 }\n");
    strbuf_free(&line);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_and_lifetimes_are_spread_evenly_between_their_bounds),
        cmocka_unit_test(same_seed_gives_the_same_templates_and_another_one_others),
        cmocka_unit_test(lives_do_not_hang_on_the_step),
        cmocka_unit_test(slices_have_templates_of_their_own),
        cmocka_unit_test(instances_are_exchanged_where_they_match),
        cmocka_unit_test(fewer_act_by_amount),
        cmocka_unit_test(all_lie_in_the_region_and_all_over_it),
        cmocka_unit_test(none_is_put_where_there_is_no_place),
        cmocka_unit_test(align_turns_the_upper_edge),
        cmocka_unit_test(spread_turns_each_by_less_than_it_says),
        cmocka_unit_test(border_fades_as_a_gaussian),
        cmocka_unit_test(pictures_and_velocities_turn_together),
        cmocka_unit_test(groups_of_both_kinds_are_drawn_over_each_other),
        cmocka_unit_test(what_reaches_a_cell_is_drawn_there),
        cmocka_unit_test(they_come_and_go_by_fade),
        cmocka_unit_test(one_is_put_by_hand_and_goes_again),
        cmocka_unit_test(hand_makes_room_for_the_newest),
        cmocka_unit_test(line_for_the_file_says_it_all),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
