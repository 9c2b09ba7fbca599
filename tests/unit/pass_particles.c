// What the host knows of particles: when they are born, and where on a mesh.
#include "base/memory.h"
#include "pass/particles/particles_parts.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h> // wants the headers above

static particles_births next(particles_clock *clock, double step, particles_rates rates) {
    rates.begin = (double)clock->steps * step;
    rates.step = step;
    return particles_next(clock, &rates, 1000);
}

static void no_birth_is_lost_to_rounding(void **state) {
    (void)state;
    static const double rates[] = {0.7, 59.99, 60, 1234.5, 50000};
    for (size_t i = 0; i < COUNT_OF(rates); i++) {
        particles_clock clock = {0};
        for (int k = 1; k <= 6000; k++) {
            particles_births b = next(&clock, 1.0 / 60, (particles_rates){.rate = rates[i]});
            double wanted = rates[i] * k / 60;
            assert_true(fabs((double)clock.born - wanted) < 1 + 1e-6);
            assert_true(b.first + b.steady == clock.born && b.burst == 0);
        }
    }
}

// Moments of birth, one after the other, are 1 / rate apart, over the ends of steps too.
static void births_are_evenly_spread_in_time(void **state) {
    (void)state;
    const double step = 1.0 / 60, rate = 233;
    particles_clock clock = {0};
    double last = 0;
    for (int k = 0; k < 600; k++) {
        particles_births b = next(&clock, step, (particles_rates){.rate = rate});
        for (uint32_t i = 0; i < b.steady; i++) {
            double rest = b.steady_rest - i * b.every, moment = (k + 1) * step - rest;
            assert_true(rest > -1e-9 && rest < step + 1e-9);
            assert_true(fabs(moment - last - 1 / rate) < 1e-9);
            last = moment;
        }
    }
}

static void bursts_come_when_they_should(void **state) {
    (void)state;
    const double step = 0.1;
    particles_clock clock = {0};
    particles_rates once = {.burst = 7}, later = {.burst = 5, .burst_time = 0.34};
    particles_births b = next(&clock, step, once);
    assert_true(b.burst == 7 && fabs(b.burst_rest - step) < 1e-12);
    for (int k = 1; k < 10; k++) {
        b = next(&clock, step, k < 3 ? once : later);
        assert_int_equal(b.burst, k == 3 ? 5 : 0);
        if (k == 3) assert_true(fabs(b.burst_rest - 0.06) < 1e-9);
    }
    assert_int_equal(clock.born, 12);
    // Every 0.25 s, from the middle of a period on: at 0.05, 0.3, 0.55 ...
    clock = (particles_clock){0};
    const particles_rates again = {.burst = 2, .burst_time = -0.2, .burst_period = 0.25};
    for (int k = 0; k < 100; k++) next(&clock, step, again);
    assert_int_equal(clock.born, 2 * 40);
    // Several in one step, at the moments of neighbouring steps once each.
    clock = (particles_clock){0};
    const particles_rates quick = {.burst = 1, .burst_period = 0.05};
    for (int k = 0; k < 100; k++) next(&clock, step, quick);
    assert_int_equal(clock.born, 200);
    const particles_rates mad = {.burst = 1e7, .burst_period = 1e-30};
    b = next(&clock, step, mad);
    assert_true(b.burst == 1000 && clock.born < 1e13);
}

// Only the last of them find room, and they are the ones born last.
static void more_than_there_is_room_for_leave_out_the_first(void **state) {
    (void)state;
    particles_clock clock = {0};
    particles_births b = next(&clock, 1, (particles_rates){.rate = 2500, .burst = 800});
    assert_true(b.steady == 1000 && b.burst == 0 && b.first == 2300 && clock.born == 3300);
    assert_true(fabs(b.steady_rest - 999 * b.every) < 1e-9); // the last is born at the very end
    b = next(&clock, 1, (particles_rates){.rate = 700, .burst = 800, .burst_time = 1});
    assert_true(b.steady == 700 && b.burst == 300 && b.first == 3800 && clock.born == 4800);
}

// Sixteen million particles in bindings of 128 MiB, which is all that some devices have.
static void all_fit_into_bindings_of_any_device(void **state) {
    (void)state;
    assert_int_equal(PASS_PARTICLES_MOST, 1 << 24);
    assert_true(16 * (uint64_t)PASS_PARTICLES_EACH <= UINT64_C(1) << 27);
    assert_true(PASS_PARTICLES_MOST <= PARTICLES_PARTS * PASS_PARTICLES_EACH);
    assert_true(4 * (uint64_t)PASS_PARTICLES_MOST <= UINT64_C(1) << 27); // the quantities
    assert_int_equal(sizeof(particles_triangle), 48);                    // as the shader has it
}

// ---- a mesh -----------------------------------------------------------------------------------

enum { TRIANGLES = 300 };

// Triangle i has the area wanted[i] / 2.
static uint32_t list(const double *wanted, uint32_t count, particles_triangle *out) {
    mesh_vertex *vertices = mem_alloc(3 * count * sizeof *vertices);
    uint32_t *indices = mem_alloc(3 * count * sizeof *indices);
    for (uint32_t i = 0; i < count; i++) {
        vertices[3 * i].position[0] = vertices[3 * i + 1].position[0] = (float)i;
        vertices[3 * i + 2].position[0] = (float)i;
        vertices[3 * i + 1].position[1] = 1;
        vertices[3 * i + 2].position[2] = (float)wanted[i];
    }
    for (uint32_t i = 0; i < 3 * count; i++) indices[i] = i;
    uint32_t result = particles_list_triangles(&(mesh_data){.vertices = vertices,
                                                            .vertex_count = 3 * count,
                                                            .indices = indices,
                                                            .index_count = 3 * count},
                                               out);
    mem_free(vertices);
    mem_free(indices);
    return result;
}

// The probabilities that the table stands for are the areas, exactly.
static void the_table_of_triangles_has_their_areas(void **state) {
    (void)state;
    double wanted[TRIANGLES], got[TRIANGLES] = {0}, sum = 0;
    particles_triangle out[TRIANGLES];
    for (int i = 0; i < TRIANGLES; i++) sum += wanted[i] = i % 7 == 0 ? 0 : exp(0.03 * i);
    uint32_t count = list(wanted, TRIANGLES, out);
    assert_int_equal(count, TRIANGLES - (TRIANGLES + 6) / 7);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(out[i].other < count && out[i].chance >= 0 && out[i].chance <= 1);
        got[(int)out[i].corner[0]] += (double)out[i].chance / count;
        got[(int)out[out[i].other].corner[0]] += (1 - (double)out[i].chance) / count;
    }
    for (int i = 0; i < TRIANGLES; i++) assert_true(fabs(got[i] - wanted[i] / sum) < 1e-7);
}

static void a_mesh_without_area_is_refused(void **state) {
    (void)state;
    const double wanted[3] = {0};
    particles_triangle out[3];
    assert_int_equal(list(wanted, 3, out), 0);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_birth_is_lost_to_rounding),
        cmocka_unit_test(births_are_evenly_spread_in_time),
        cmocka_unit_test(bursts_come_when_they_should),
        cmocka_unit_test(more_than_there_is_room_for_leave_out_the_first),
        cmocka_unit_test(all_fit_into_bindings_of_any_device),
        cmocka_unit_test(the_table_of_triangles_has_their_areas),
        cmocka_unit_test(a_mesh_without_area_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
