// Recipes of pictures: what is written is read, and a stranger's is read with care.
#include "effect_helper.h"

#include "effect/recipe.h"

static const effect_param gain = {
    .desc = {"gain", VALUE_NUMBER, 1, .value = {0.5f}, .min = 0, .max = 2, .unit = "", .help = ""}};

static void what_is_written_is_read(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    assert_int_equal(effect_add_param(s->e, &gain), 0);
    ok(effect_check_settings(s->e));
    ok(effect_set(s->e, "gain", "1.5"));
    ok(effect_set(s->e, "march.albedo", "1,\n0,0")); // stays on its line
    ok(effect_set(s->e, "camera.eye", "1,2,3"));
    png_text texts[RECIPE_TEXTS], read[PNG_MAX_TEXTS];
    arena memory = {0};
    recipe_write(s->e, 12.25, 640, 360, &memory, texts);
    static const uint8_t pixels[3] = {1, 2, 3};
    char path[PATH_CAP];
    assert_true(path_join(path, s->folder, "shot.png"));
    ok(png_write(path, &(png_image){1, 1, 3, 8, pixels}, texts, RECIPE_TEXTS));
    size_t count;
    recipe r;
    ok(png_read_texts(path, &memory, read, &count));
    assert_int_equal(count, RECIPE_TEXTS);
    ok(recipe_read(read, count, &memory, &r));
    assert_true(r.frame == 12.25 && r.width == 640 && r.height == 360);
    assert_null(r.file); // the test's lies in /tmp
    static const char *const expected[][2] = {
        {"gain", "1.5"}, {"camera.eye", "1,2,3"}, {"march.albedo", "1, 0,0"}};
    assert_int_equal(r.setting_count, COUNT_OF(expected));
    for (size_t i = 0; i < COUNT_OF(expected); i++) {
        assert_string_equal(r.settings[i].name, expected[i][0]);
        assert_string_equal(r.settings[i].text, expected[i][1]);
    }
    arena_free(&memory);
}

static bool read_one(const char *key, const char *value, recipe *out, arena *memory) {
    png_text texts[] = {{"roil:effect", "effects/a.lua"},
                        {"roil:frame", "3"},
                        {"roil:size", "64x32"},
                        {"roil:settings", "a=1\nb.c=2,3\n"}};
    for (size_t i = 0; i < COUNT_OF(texts); i++)
        if (strcmp(texts[i].key, key) == 0) texts[i].value = value;
    return recipe_read(texts, COUNT_OF(texts), memory, out);
}

static void effects_outside_are_not_opened_unasked(void **state) {
    (void)state;
    static const struct {
        const char *file;
        bool inside;
    } cases[] = {
        {"a.lua", true},
        {"effects/a..b/c.lua", true},
        {"..a/b.lua", true},
        {"/etc/a.lua", false},
        {"../a.lua", false},
        {"effects/../../a.lua", false},
        {"effects/../a.lua", false},
    };
    arena memory = {0};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe r;
        ok(read_one("roil:effect", cases[i].file, &r, &memory));
        if ((r.file != NULL) != cases[i].inside) fail_msg("%s", cases[i].file);
    }
    arena_free(&memory);
}

static void damaged_recipes_are_refused(void **state) {
    (void)state;
    static const char *const cases[][3] = {
        {"roil:effect", "a.txt", "no .lua file"},
        {"roil:effect", "a\x1b[2J.lua", "no .lua file"},
        {"roil:frame", "", "frame is ''"},
        {"roil:frame", "-1", "accepted: 0 to"},
        {"roil:frame", "nan", "accepted: 0 to"},
        {"roil:frame", "1e10", "accepted: 0 to"},
        {"roil:frame", "3 4", "accepted: 0 to"},
        {"roil:size", "0x10", "accepted: 1x1"},
        {"roil:size", "10x99999", "accepted: 1x1"},
        {"roil:size", "10x20x30", "accepted: 1x1"},
        {"roil:settings", "a", "setting 1 of the recipe"},
        {"roil:settings", "a=1\n\nb=2", "setting 2 of the recipe"},
        {"roil:settings", "a b=1", "setting 1 of the recipe"},
        {"roil:settings", "=1", "setting 1 of the recipe"},
        {"roil:settings", "a=1\x1b[2J", "setting 1 of the recipe"},
    };
    arena memory = {0};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe r;
        err_clear();
        if (read_one(cases[i][0], cases[i][1], &r, &memory)) fail_msg("%s was taken", cases[i][1]);
        assert_error(cases[i][2]);
    }
    strbuf many = {0};
    for (int i = 0; i <= RECIPE_MAX_SETTINGS; i++) strbuf_add(&many, "a=%d\n", i);
    recipe r;
    assert_false(read_one("roil:settings", strbuf_text(&many), &r, &memory));
    assert_error("more than 4096 settings");
    strbuf_free(&many);
    assert_false(recipe_read(NULL, 0, &memory, &r));
    assert_error("has no recipe of how it was made");
    arena_free(&memory);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        STAGE_TEST(what_is_written_is_read),
        cmocka_unit_test(effects_outside_are_not_opened_unasked),
        cmocka_unit_test(damaged_recipes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
