// Names that C says to shaders: each is in a shader of those that it is said to. One that is not
// would be silence: a number that nothing reads, a buffer that is never bound.
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "pass/march/probe.h"
#include "pass/ranges.h"
#include "roil/view.h"
#include "scene/voxels.h"
#include "sim/flow.h"
#include "sim/lbm_guard.h"
#include "sim/pyro.h"

enum { MOST_FILES = 256 };

typedef struct shader_files {
    const char *items[MOST_FILES];
    size_t count;
} shader_files;

static void add_file(shader_files *list, const char *file) {
    assert_true(list->count < MOST_FILES);
    if (file) list->items[list->count++] = file;
}

static void add_type(shader_files *list, const pass_type *type) {
    add_file(list, type->shader);
    for (size_t i = 0; i < type->kernel_count; i++) {
        add_file(list, type->kernels[i].shader);
        add_file(list, type->kernels[i].vertex);
    }
}

static shader_library *open_shaders(void) {
    char root[PATH_CAP];
    const char *source = getenv("ROIL_SOURCE_DIR");
    assert_true(path_join(root, source ? source : "..", "shaders"));
    shader_library *library =
        shader_library_create(&(shader_library_desc){.shader_root = root, .remembers = true});
    if (!library) fail_msg("%s", err_get());
    return library;
}

static void check(shader_library *library, const char *whose, const kernel_table *table) {
    const char *name = kernel_undeclared(library, table);
    if (name) fail_msg("%s: no shader declares '%s'", whose, name);
}

static void solvers_say_what_their_shaders_declare(void **state) {
    shader_library *library = *state;
    check(library, "flow", &flow_kernel_table);
    check(library, "lbm", &lbm_kernel_table);
    check(library, "pyro", &pyro_kernel_table);
    check(library, "lbm_guard", &lbm_guard_kernel_table);
    check(library, "voxels", &voxels_kernel_table);
    check(library, "view", &view_kernel_table);
    check(library, "ranges", &ranges_kernel_table);
}

static void passes_say_what_their_shaders_declare(void **state) {
    size_t count;
    const pass_type *const *types = pass_types(&count);
    for (size_t i = 0; i < count; i++) {
        if (!types[i]->names.items) continue;
        shader_files files = {.count = 0};
        for (size_t k = 0; k < count; k++) // types of a family have one table
            if (types[k]->names.items == types[i]->names.items) add_type(&files, types[k]);
        const kernel_table table = {types[i]->names, files.items, files.count};
        check(*state, types[i]->name, &table);
    }
    shader_files files = {.count = 0};
    add_type(&files, &pass_probe_type); // of which no script makes any
    check(*state, "probe", &(kernel_table){pass_probe_type.names, files.items, files.count});
}

static void providers_have_what_some_shader_asks_for(void **state) {
    size_t type_count;
    const pass_type *const *types = pass_types(&type_count);
    shader_files files = {.count = 0};
    for (size_t i = 0; i < type_count; i++) add_type(&files, types[i]);
    add_file(&files, "pass/light/point_lights_lists.comp");
    for (size_t i = 0; i < PASS_PROVIDERS; i++) {
        const pass_provider *row = pass_providers[i];
        const bool counts = row->slots.count && strcmp(row->slots.items[0], "Counters") == 0;
        if (counts) continue; // of the compiler's prelude
        check(*state, "slots", &(kernel_table){row->slots, files.items, files.count});
        check(*state, "uniforms", &(kernel_table){row->uniforms, files.items, files.count});
    }
}

// A kernel whose define is misspelt would run as another one.
static void check_define(shader_library *library, const char *whose, const pass_kernel *row,
                         const char *shader) {
    const char *const files[] = {shader, row->vertex ? row->vertex : shader};
    if (!row->define) return;
    if (!shader_mentions(library, files[0], row->define) &&
        !shader_mentions(library, files[1], row->define))
        fail_msg("%s: %s does not mention the define '%s'", whose, shader, row->define);
}

// Numbers reach a kernel through the interface of the type's own shader alone.
static void check_uniforms(shader_library *library, const pass_type *type, const char *shader) {
    arena memory = {0};
    const shader_interface *whole = shader_interface_load(library, &memory, type->shader, NULL);
    const shader_interface *part = shader_interface_load(library, &memory, shader, NULL);
    if (!whole || !part) fail_msg("%s", err_get());
    for (size_t i = 0; i < part->uniform_count; i++) {
        bool found = false;
        for (size_t k = 0; k < whole->uniform_count && !found; k++)
            found = strcmp(whole->uniforms[k].name, part->uniforms[i].name) == 0;
        if (!found)
            fail_msg("%s: %s declares the uniform '%s', which %s does not", type->name, shader,
                     part->uniforms[i].name, type->shader);
    }
    arena_free(&memory);
}

static void kernels_are_parts_of_their_types(void **state) {
    size_t count;
    const pass_type *const *types = pass_types(&count);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < types[i]->kernel_count; k++) {
            const pass_kernel *row = &types[i]->kernels[k];
            const char *shader = row->shader ? row->shader : types[i]->shader;
            check_define(*state, types[i]->name, row, shader);
            if (row->shader) check_uniforms(*state, types[i], row->shader);
        }
    }
}

static void a_name_that_is_misspelt_is_found(void **state) {
    static const char *const names[] = {"steps", "stpes"};
    static const char *const files[] = {"pass/march/march.comp"};
    const kernel_table table = {{names, COUNT_OF(names)}, files, 1};
    assert_string_equal(kernel_undeclared(*state, &table), "stpes");
}

static void words_count_whole(void **state) {
    static const char *const files[] = {"pass/picture/bloom.comp"};
    static const char *const part[] = {"evels"}, *const comment[] = {"halves"};
    const kernel_table parts = {{part, 1}, files, 1}, comments = {{comment, 1}, files, 1};
    assert_string_equal(kernel_undeclared(*state, &parts), "evels");
    assert_string_equal(kernel_undeclared(*state, &comments), "halves");
}

static int set_up(void **state) {
    *state = open_shaders();
    return 0;
}

static int tear_down(void **state) {
    shader_library_destroy(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solvers_say_what_their_shaders_declare),
        cmocka_unit_test(passes_say_what_their_shaders_declare),
        cmocka_unit_test(providers_have_what_some_shader_asks_for),
        cmocka_unit_test(kernels_are_parts_of_their_types),
        cmocka_unit_test(a_name_that_is_misspelt_is_found),
        cmocka_unit_test(words_count_whole),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
