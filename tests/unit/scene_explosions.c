// A list of explosions: who goes on at a time, who makes room, what is forgotten.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/memory.h"
#include "scene/explosions.h"
#include <math.h>
#include <string.h>

static scene_explosion at(double time) {
    return (scene_explosion){.time = time, .size = 1, .life = 1};
}

static void add(scene_explosions *list, double time) {
    scene_explosion one = at(time);
    assert_true(scene_explosions_add(list, &one));
}

static void the_youngest_come_first(void **state) {
    (void)state;
    scene_explosions *list = mem_alloc(sizeof *list);
    const double times[] = {1, 3, 0, 2, 3};
    for (size_t i = 0; i < COUNT_OF(times); i++) add(list, times[i]);
    const scene_explosion *out[8];
    assert_int_equal(scene_explosions_alive(list, -1, 9, out, 8), 0);
    assert_int_equal(scene_explosions_alive(list, 3.5, 9, out, 8), 5);
    assert_ptr_equal(out[0], &list->all[1]); // of two that begin at once, the first
    assert_ptr_equal(out[1], &list->all[4]);
    assert_true(out[2]->time == 2 && out[3]->time == 1 && out[4]->time == 0);
    assert_int_equal(scene_explosions_alive(list, 3.5, 9, out, 2), 2);
    assert_true(out[0]->time == 3 && out[1]->time == 3);
    assert_int_equal(scene_explosions_alive(list, 3.5, 2, out, 8), 3);
    assert_int_equal(scene_explosions_alive(list, 3, 1, out, 8), 2); // at its end it is gone
    list->all[2].life = 4;
    assert_int_equal(scene_explosions_alive(list, 3, 1, out, 8), 3);
    mem_free(list);
}

static void of_a_full_list_the_first_that_came_makes_room(void **state) {
    (void)state;
    scene_explosions *list = mem_alloc(sizeof *list);
    for (int i = 0; i < 3; i++) add(list, i);
    list->fixed = list->count;
    for (int i = 3; i < SCENE_EXPLOSIONS_MAX + 2; i++) add(list, i);
    assert_int_equal(list->count, SCENE_EXPLOSIONS_MAX);
    assert_true(list->all[2].time == 2 && list->all[3].time == 5);
    assert_true(list->all[SCENE_EXPLOSIONS_MAX - 1].time == SCENE_EXPLOSIONS_MAX + 1);
    assert_int_equal(scene_explosions_seed(list), SCENE_EXPLOSIONS_MAX + 3);
    scene_explosions_reset(list);
    assert_int_equal(list->count, 3);
    assert_int_equal(scene_explosions_seed(list), 4);
    list->fixed = list->count = SCENE_EXPLOSIONS_MAX;
    scene_explosion one = at(0);
    assert_false(scene_explosions_add(list, &one));
    mem_free(list);
}

static void each_has_numbers_of_its_own(void **state) {
    (void)state;
    double sum = 0;
    for (uint32_t seed = 0; seed < 500; seed++) {
        scene_explosion one = {.seed = seed}, next = {.seed = seed + 1};
        float own[4], again[4], other[4];
        scene_explosion_chance(&one, own);
        scene_explosion_chance(&one, again);
        scene_explosion_chance(&next, other);
        for (int i = 0; i < 4; i++) {
            assert_true(own[i] >= 0 && own[i] < 1 && own[i] == again[i] && own[i] != other[i]);
            sum += (double)own[i];
        }
    }
    assert_true(fabs(sum / 2000 - 0.5) < 0.03);
}

static void numbers_at_fault_are_named(void **state) {
    (void)state;
    scene_explosion one = at(0);
    assert_true(scene_explosion_check(&one));
    one.life = 0;
    assert_false(scene_explosion_check(&one));
    assert_non_null(strstr(err_get(), "'life' is 0"));
    one = at((double)NAN);
    assert_false(scene_explosion_check(&one));
    assert_non_null(strstr(err_get(), "'time'"));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_youngest_come_first),
        cmocka_unit_test(of_a_full_list_the_first_that_came_makes_room),
        cmocka_unit_test(each_has_numbers_of_its_own),
        cmocka_unit_test(numbers_at_fault_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
