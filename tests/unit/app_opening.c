// What a path leads to, and what it does not.
#include "roil_helper.h"

#include "app/opening.h"
#include "app/starts.h"
#include <stdlib.h>
#include <unistd.h>

static char home[PATH_CAP];

static void enter(void) {
    helper_source(home, ".");
    assert_int_equal(chdir(helper_folder), 0);
}

static void effects_are_themselves(void **state) {
    (void)state;
    opening o;
    enter();
    helper_put("e.lua", "local fx = effect { }\n");
    need(opening_find(home, "e.lua", &o));
    assert_string_equal(o.file, "e.lua");
    assert_null(o.recipe);
    opening_free(&o);
}

static void what_is_none_is_refused(void **state) {
    (void)state;
    opening o;
    enter();
    helper_put("text.png", "no picture");
    helper_put("a \"b\".vdb", "no volume");
    helper_put("c_1.vdb", "no volume");
    refused(opening_find(home, "nowhere.lua", &o), "nowhere.lua");
    refused(opening_find(home, ".", &o), "is a folder");
    refused(opening_find(home, "nowhere.png", &o), "there is no such file");
    refused(opening_find(home, "text.png", &o), "text.png");
    refused(opening_find(home, "nowhere.vdb", &o), "there is no such file");
    refused(opening_find(home, "a \"b\".vdb", &o), "rename it");
    refused(opening_find(home, "c_1.vdb", &o), "c_1.vdb");
    assert_string_equal(o.file, "");
    assert_false(file_exists("c.lua"));
}

static void new_ones_replace_nothing(void **state) {
    (void)state;
    opening o;
    enter();
    need(opening_new(helper_roil, "burst", "mine", &o));
    assert_string_equal(o.file, "mine.lua");
    refused(opening_new(helper_roil, "burst", "mine", &o), "there is a mine.lua already");
    assert_string_equal(o.file, "");
    refused(opening_new(helper_roil, "burst", "../mine", &o), "is no name");
    refused(opening_new(helper_roil, "nothing", "other", &o),
            "no effect 'nothing' comes with roil");
    assert_false(file_exists("other.lua"));
}

static void all_that_one_can_begin_with_are_effects(void **state) {
    (void)state;
    char path[PATH_CAP];
    helper_source(home, ".");
    for (size_t i = 0; i < STARTS; i++) {
        need(starts_find(home, starts[i].name, path));
        roil_effect *e = roil_load(helper_roil, path, NULL, 0);
        need(e);
        need(roil_check(e));
        roil_unload(e);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(effects_are_themselves),
        cmocka_unit_test(what_is_none_is_refused),
        cmocka_unit_test(new_ones_replace_nothing),
        cmocka_unit_test(all_that_one_can_begin_with_are_effects),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
