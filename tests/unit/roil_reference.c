// The reference and the vocabulary are one: what Lua has is told about, and what is told is so.
#include "script_helper.h"

#include "base/memory.h"
#include "field/sequence.h"
#include "pass/pass.h"
#include "roil.h"
#include "script/reference.h"
#include "script/vm.h"

// Whether Lua itself, as the sandbox opens it, has the global.
static bool is_luas_own(const vm *own, const char *name) {
    lua_State *L = vm_lua((vm *)(uintptr_t)own);
    lua_pushglobaltable(L);
    lua_pushstring(L, name);
    bool found = lua_rawget(L, -2) != LUA_TNIL;
    lua_pop(L, 2);
    return found;
}

static bool is_pass(const char *name) {
    size_t count;
    const pass_type *const *types = pass_types(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(types[i]->name, name) == 0) return true;
    return false;
}

// An effect with a parameter "g_NAME" for each of its globals.
static effect *load_globals(void) {
    effect *e = helper_load("local fx = effect { }\n"
                            "for name in pairs(_G) do param { 'g_' .. name, 0 } end\n"
                            "fx.output = geometry { }");
    if (!e) fail_msg("%s", err_get());
    return e;
}

static bool has_global(effect *e, const char *name) {
    for (size_t i = 0; i < effect_param_count(e); i++)
        if (strcmp(effect_get_param(e, i)->desc.name + 2, name) == 0) return true;
    return false;
}

static void every_global_is_documented(void **state) {
    (void)state;
    vm *own = vm_create(&(vm_desc){.root = helper_folder, .memory = 1 << 20});
    assert_non_null(own);
    effect *e = load_globals();
    size_t checked = 0;
    for (size_t i = 0; i < effect_param_count(e); i++) {
        const char *name = effect_get_param(e, i)->desc.name + 2;
        if (is_luas_own(own, name) || is_pass(name)) continue;
        char *text = roil_info_fields(name);
        if (!text) fail_msg("%s: %s", name, err_get());
        assert_memory_equal(text, name, strlen(name));
        roil_free(text);
        checked++;
    }
    assert_true(checked > 40);
    effect_destroy(e);
    vm_destroy(own);
}

static bool has_module(const char *name) {
    char file[PATH_CAP], path[PATH_CAP];
    snprintf(file, sizeof file, "scripts/lib/%s.lua", name);
    helper_source(path, file);
    return file_exists(path);
}

static void what_is_documented_is_a_global(void **state) {
    (void)state;
    effect *e = load_globals();
    const script_object *object;
    char *listing = roil_info_fields(NULL);
    for (size_t i = 0; (object = script_object_at(i)); i++) {
        char line[80];
        snprintf(line, sizeof line, "\n  %s ", object->name);
        if (!strstr(listing, line)) fail_msg("%s is not listed", object->name);
        bool module = strstr(object->form, "require \"");
        if (module ? !has_module(object->name) : !has_global(e, object->name))
            fail_msg("%s is no %s", object->name, module ? "module" : "global");
    }
    for (const field_kind *kind = field_kinds; kind->name; kind++)
        if (script_has_kind(kind) && !has_global(e, kind->name))
            fail_msg("%s is no global", kind->name);
    roil_free(listing);
    effect_destroy(e);
}

static void inner_kinds_are_not_shown(void **state) {
    (void)state;
    static const char *const inner[] = {"constant", "call", "grid", "swizzle"};
    for (size_t i = 0; i < COUNT_OF(inner); i++) assert_null(roil_info_fields(inner[i]));
    char *listing = roil_info_fields(NULL);
    const char *first = strstr(listing, "\n  palette ");
    assert_non_null(first);
    assert_null(strstr(first + 1, "\n  palette "));
    roil_free(listing);
}

static void unknown_names_are_compared_with_both_tables(void **state) {
    (void)state;
    assert_null(roil_info_fields("pallete"));
    assert_non_null(strstr(err_get(), "did you mean 'palette'?"));
    assert_null(roil_info_fields("wurley"));
    assert_non_null(strstr(err_get(), "did you mean 'worley'?"));
}

static void one_object_is_told_with_its_keys(void **state) {
    (void)state;
    char *text = roil_info_fields("vdb");
    assert_non_null(strstr(text, "vdb (source)\n"));
    assert_non_null(strstr(text, "  fps = 24 frames/s "));
    assert_non_null(strstr(text, "  loop = clip* | extend | repeat | ping_pong"));
    roil_free(text);
}

static void words_are_those_of_the_enumerations(void **state) {
    (void)state;
    const value_desc *shape = script_key_find(script_object_find("curve")->keys, "shape");
    assert_int_equal(shape->word_count, CURVE_SHAPE_COUNT);
    for (int i = 0; i < CURVE_SHAPE_COUNT; i++)
        assert_string_equal(shape->words[i], curve_shape_name((curve_shape)i));
    const value_desc *loop = script_key_find(script_object_find("vdb")->keys, "loop");
    assert_int_equal(loop->word_count, SEQUENCE_PING_PONG + 1);
    for (int i = 0; i <= SEQUENCE_PING_PONG; i++)
        assert_string_equal(loop->words[i], sequence_loop_name((sequence_loop)i));
}

// The numbers that `object` claims as defaults are those in the scene's structure.
static void check_defaults(const char *object, void *structure) {
    const script_object *row = script_object_find(object);
    size_t checked = 0;
    for (const scene_value *v = NULL; (v = script_object_value(row, v)); checked++) {
        const field *node = *scene_slot(structure, v);
        assert_int_equal(!node, v->desc.form != NULL); // the eye of an orbit, a night
        if (!node) continue;
        assert_int_equal(node->components, v->desc.components);
        assert_memory_equal(node->value, v->desc.value, sizeof(float[3]));
    }
    assert_true(checked > 3);
}

static void defaults_are_those_of_the_scene(void **state) {
    (void)state;
    effect *e = helper_load("local fx = effect { } fx.output = geometry { }");
    assert_non_null(e);
    scene *s = effect_scene(e);
    check_defaults("orbit", &s->camera);
    check_defaults("sun", &s->sun);
    check_defaults("sky", &s->sky);
    helper_put("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    scene_mesh *mesh = effect_add_mesh(e, "one.obj");
    if (!mesh) fail_msg("%s", err_get());
    check_defaults("mesh", mesh);
    effect_destroy(e);
}

static void objects_take_what_they_need(void **state) {
    (void)state;
    static const struct {
        const char *object, *key;
        bool takes;
    } cases[] = {
        {"camera", "eye", true},
        {"camera", "yaw", false},
        {"orbit", "eye", false},
        {"orbit", "yaw", true},
        {"sky", "moon", true},
        {"sky", "image", true},
        {"point_light", "range", true},
        {"point_light", "radius", false},
        {"point_light", "angle", false},
        {"sphere_light", "radius", true},
        {"sphere_light", "angle", false},
        {"spot_light", "angle", true},
        {"spot_light", "falloff", true},
        {"node", "scale", true},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const value_desc *key;
        bool found = false;
        for (size_t k = 0; (key = script_object_key(script_object_find(cases[i].object), k)); k++)
            found = found || strcmp(key->name, cases[i].key) == 0;
        if (found != cases[i].takes) fail_msg("%s: %s", cases[i].object, cases[i].key);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_global_is_documented),
        cmocka_unit_test(what_is_documented_is_a_global),
        cmocka_unit_test(inner_kinds_are_not_shown),
        cmocka_unit_test(unknown_names_are_compared_with_both_tables),
        cmocka_unit_test(one_object_is_told_with_its_keys),
        cmocka_unit_test(words_are_those_of_the_enumerations),
        cmocka_unit_test(defaults_are_those_of_the_scene),
        cmocka_unit_test(objects_take_what_they_need),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
