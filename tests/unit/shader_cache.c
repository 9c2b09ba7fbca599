// The cache on disk: what hits, what misses, and that damage only costs time.
#include "base/memory.h"
#include "shader_helper.h"
#include <sys/stat.h>

static const char shader[] = "//@ option mode = a {a, b} : x\n"
                             "writeonly uniform image2D color; //= output rgba16f : x\n"
                             "void main() { imageStore(color, ivec2(MODE), vec4(VALUE)); }\n";
static const shader_define one[] = {{"VALUE", "1"}}, two[] = {{"VALUE", "2"}};

static uint64_t compiles(place *p) {
    return shader_library_compiles(p->library);
}

static shader_binary compile(place *p, const shader_define *define) {
    shader_binary binary;
    place_compile(p, &(shader_compile_desc){.name = "a.comp", .defines = define, .define_count = 1},
                  &binary);
    return binary;
}

static void reopen(place *p) {
    shader_library_destroy(p->library);
    place_open(p);
}

// The only entry of the cache.
static void entry(place *p, char out[PATH_CAP]) {
    char pattern[PATH_CAP];
    file_list list;
    assert_true(path_join(pattern, p->cache, "*"));
    assert_true(file_glob(pattern, &list));
    assert_int_equal(list.count, 1);
    assert_true(path_join(out, "", list.paths[0]));
    file_list_free(&list);
}

static void a_second_compile_is_a_hit(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", shader);
    shader_binary first = compile(p, one);
    assert_int_equal(compiles(p), 1);
    shader_binary second = compile(p, one);
    assert_int_equal(compiles(p), 1);
    reopen(p); // another process
    shader_binary third = compile(p, one);
    assert_int_equal(compiles(p), 0);
    assert_int_equal(first.size, second.size);
    assert_int_equal(first.size, third.size);
    assert_memory_equal(first.code, third.code, first.size);
    assert_int_equal(third.slot_count, 1);
    assert_string_equal(third.slots[0].name, "color");
    assert_int_equal(third.local_size[0], 16);
    assert_int_equal(third.file_count, 1);
}

static void whatever_changes_the_code_misses(void **state) {
    place *p = *state;
    shader_binary binary;
    const size_t b[] = {1};
    place_write(p, "program/a.comp", shader);
    compile(p, one);
    compile(p, two);
    assert_int_equal(compiles(p), 2);
    shader_compile_desc desc = {
        .name = "a.comp", .defines = one, .define_count = 1, .options = b, .option_count = 1};
    place_compile(p, &desc, &binary);
    assert_int_equal(compiles(p), 3);
    place_write(p, "program/lib/x.glsl", "float x() { return 1.0; }\n");
    place_write(p, "program/a.comp", "#include \"lib/x.glsl\"\nvoid main() { x(); }\n");
    compile(p, one);
    assert_int_equal(compiles(p), 4);
    place_write(p, "program/lib/x.glsl", "float x() { return 2.0; }\n");
    compile(p, one);
    assert_int_equal(compiles(p), 5);
}

static void comments_do_not_miss(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", "void main() {} // one  \n");
    compile(p, one);
    place_write(p, "program/a.comp", "void main() {} // other\n");
    compile(p, one);
    assert_int_equal(compiles(p), 1);
}

static void a_copied_tree_hits(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", shader);
    compile(p, one);
    place_write(p, "moved/a.comp", shader);
    snprintf(p->program, sizeof p->program, "%s/moved", p->top);
    reopen(p);
    compile(p, one);
    assert_int_equal(compiles(p), 0);
}

static void damage_is_found_and_repaired(void **state) {
    place *p = *state;
    char path[PATH_CAP];
    void *data;
    size_t size;
    place_write(p, "program/a.comp", shader);
    shader_binary whole = compile(p, one);
    entry(p, path);
    assert_true(file_read(path, 1 << 20, &data, &size));
    unsigned char *bytes = data;
    const size_t sizes[] = {0, 1, 20, size / 2, size - 1, size - 4};
    uint64_t before = compiles(p);
    for (size_t i = 0; i < 6; i++) {
        assert_true(file_write(path, data, sizes[i]));
        shader_binary again = compile(p, one);
        assert_int_equal(compiles(p), ++before);
        assert_memory_equal(again.code, whole.code, whole.size);
    }
    for (size_t at = 0; at < size; at += size / 16 + 1) {
        bytes[at] ^= 0x40;
        assert_true(file_write(path, data, size));
        bytes[at] ^= 0x40;
        shader_binary again = compile(p, one);
        assert_int_equal(compiles(p), ++before);
        assert_memory_equal(again.code, whole.code, whole.size);
    }
    compile(p, one); // the last one repaired the entry
    assert_int_equal(compiles(p), before);
    mem_free(data);
}

static void an_entry_under_a_wrong_name_is_not_used(void **state) {
    place *p = *state;
    char path[PATH_CAP];
    void *data;
    size_t size;
    place_write(p, "program/a.comp", shader);
    compile(p, one);
    entry(p, path);
    assert_true(file_read(path, 1 << 20, &data, &size));
    assert_int_equal(remove(path), 0);
    shader_binary other = compile(p, two);
    entry(p, path);
    assert_true(file_write(path, data, size));
    shader_binary again = compile(p, two);
    assert_int_equal(compiles(p), 3);
    assert_memory_equal(again.code, other.code, other.size);
    mem_free(data);
}

static void an_unwritable_cache_is_no_error(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", shader);
    place_write(p, "file", "x");
    snprintf(p->cache, sizeof p->cache, "%s/file", p->top);
    reopen(p);
    compile(p, one);
    compile(p, one);
    assert_int_equal(compiles(p), 2);
}

static void a_cache_that_others_can_write_to_is_not_used(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", shader);
    assert_true(file_make_folders(p->cache));
    assert_int_equal(chmod(p->cache, 0777), 0);
    reopen(p);
    compile(p, one);
    compile(p, one);
    assert_int_equal(compiles(p), 2);
}

static void count_file(void *user, const char *path) {
    (void)path;
    ++*(int *)user;
}

// Without a folder for the cache: what is not remembered is compiled.
static void a_library_remembers_what_would_be_the_same(void **state) {
    place *p = *state;
    int told = 0;
    const shader_reader reader = {count_file, &told};
    shader_compile_desc desc = {.name = "a.comp", .reader = &reader};
    shader_binary first, again;
    shader_library_destroy(p->library);
    p->library = shader_library_create(&(shader_library_desc){
        .shader_root = p->program, .effect_root = p->effect, .remembers = true});
    place_write(p, "program/lib/x.glsl", "const int X = 1;\n");
    place_write(p, "effect/a.comp",
                "writeonly uniform image2D color; //= output rgba16f : x\n#include \"lib/x.glsl\"\n"
                "void main() { imageStore(color, ivec2(0), vec4(X)); }\n");
    place_compile(p, &desc, &first);
    for (int i = 0; i < 2; i++) {
        shader_library_forget(p->library);
        place_compile(p, &desc, &again);
        assert_int_equal(compiles(p), 1);
        assert_int_equal(told, 2 * (i + 2));
        assert_int_equal(again.size, first.size);
        assert_memory_equal(again.code, first.code, first.size);
        assert_string_equal(again.slots[0].name, "color");
        assert_int_equal(again.file_count, 2);
        assert_int_equal(again.local_size[0], 16);
    }
    desc.counters = true;
    place_compile(p, &desc, &again);
    assert_int_equal(compiles(p), 2);
    place_write(p, "program/lib/x.glsl", "const int X = 2;\n"); // another text
    shader_library_forget(p->library);
    place_compile(p, &desc, &again);
    assert_int_equal(compiles(p), 3);
    place_write(p, "effect/lib/x.glsl", "const int X = 2;\n"); // another file
    shader_library_forget(p->library);
    place_compile(p, &desc, &again);
    assert_int_equal(compiles(p), 4);
    assert_non_null(strstr(again.files[1], p->effect));
    assert_int_equal(unlink(again.files[1]), 0); // the first file again
    shader_library_forget(p->library);
    place_compile(p, &desc, &again);
    assert_non_null(strstr(again.files[1], p->program));
}

static void a_library_remembers_annotations(void **state) {
    place *p = *state;
    int told = 0;
    const shader_reader reader = {count_file, &told};
    shader_library_destroy(p->library);
    p->library = shader_library_create(&(shader_library_desc){
        .shader_root = p->program, .effect_root = p->effect, .remembers = true});
    place_write(p, "program/lib/x.glsl", "uniform float gain; //= 2 [0, 4] m : x\n");
    place_write(p, "program/a.comp",
                "// A pass.\n#include \"lib/x.glsl\"\n//@ option mode = soft {soft, hard} : y\n"
                "//@ field vec3 tint = 1 : z\n//@ counter hits : w\n"
                "uniform sampler2D last; //= input optional : v\nvoid main() {}\n");
    for (int i = 1; i < 4; i++) {
        arena memory = {0};
        const shader_interface *face =
            shader_interface_load(p->library, &memory, "a.comp", &reader);
        if (!face) fail_msg("%s", err_get());
        assert_int_equal(told, 2 * i);
        assert_string_equal(face->summary, "A pass.");
        assert_string_equal(face->uniforms[0].name, "gain");
        assert_string_equal(face->uniforms[0].unit, "m");
        assert_string_equal(face->options[0].words[1], "hard");
        assert_string_equal(face->fields[0].glsl_type, "vec3");
        assert_string_equal(face->images[0].help, "v");
        assert_null(face->images[0].history_of);
        assert_string_equal(face->counters[0].name, "hits");
        arena_free(&memory); // what is remembered is a copy
        shader_library_forget(p->library);
    }
    place_write(p, "program/lib/x.glsl", "uniform float bias; //= 2 [0, 4] m : x\n");
    const shader_interface *face = shader_interface_load(p->library, &p->memory, "a.comp", NULL);
    assert_string_equal(face->uniforms[0].name, "bias");
}

static void failures_are_not_cached(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", "void main() { x }\n");
    place_refuses(p, "a.comp", "a.comp:1: ");
    place_refuses(p, "a.comp", "a.comp:1: ");
    assert_int_equal(compiles(p), 2);
}

static void a_missing_folder_of_shaders_is_an_error(void **state) {
    place *p = *state;
    assert_null(shader_library_create(&(shader_library_desc){.shader_root = "/nonexistent/x"}));
    assert_error("/nonexistent/x: no such folder");
    shader_library *library =
        shader_library_create(&(shader_library_desc){.shader_root = p->program});
    assert_non_null(library); // neither effect nor cache
    place_write(p, "program/a.comp", "void main() {}\n");
    shader_binary binary;
    assert_true(
        shader_compile(library, &p->memory, &(shader_compile_desc){.name = "a.comp"}, &binary));
    shader_library_destroy(library);
    shader_library_destroy(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(a_second_compile_is_a_hit),
        PLACE_TEST(whatever_changes_the_code_misses),
        PLACE_TEST(comments_do_not_miss),
        PLACE_TEST(a_copied_tree_hits),
        PLACE_TEST(damage_is_found_and_repaired),
        PLACE_TEST(an_entry_under_a_wrong_name_is_not_used),
        PLACE_TEST(an_unwritable_cache_is_no_error),
        PLACE_TEST(a_cache_that_others_can_write_to_is_not_used),
        PLACE_TEST(a_library_remembers_what_would_be_the_same),
        PLACE_TEST(a_library_remembers_annotations),
        PLACE_TEST(failures_are_not_cached),
        PLACE_TEST(a_missing_folder_of_shaders_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
