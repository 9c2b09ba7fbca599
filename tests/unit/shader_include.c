// The include resolver: what is found, where, how often, and what is refused.
#include "shader_helper.h"

#define COLOR "writeonly uniform image2D color; //= output rgba16f : a picture\n"
#define STORE(value) "void main() { imageStore(color, ivec2(0), vec4(" value ")); }\n"

static void includes_nest_and_follow_the_includer(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/pass/a.comp", "#include \"../lib/b.glsl\"\n" COLOR STORE("b()"));
    place_write(p, "program/lib/b.glsl", "#include \"c.glsl\"\nfloat b() { return c(); }\n");
    place_write(p, "program/lib/c.glsl", "float c() { return 1.0; }"); // no newline at its end
    place_compile(p, &(shader_compile_desc){.name = "pass/a.comp"}, &binary);
    assert_int_equal(binary.file_count, 3);
    for (size_t i = 0; i < binary.file_count; i++) {
        assert_true(binary.files[i][0] == '/');
        assert_true(file_exists(binary.files[i]));
    }
}

static void a_file_is_included_once(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "#include \"b.glsl\"\n#include \"./b.glsl\"\n#include \"x/../b.glsl\"\n"
                "#include \"c.glsl\"\n" COLOR STORE("b()"));
    place_write(p, "program/b.glsl", "float b() { return 1.0; }\n");
    place_write(p, "program/c.glsl", "#include \"b.glsl\"\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_int_equal(binary.file_count, 3);
}

static void a_link_to_an_included_file_is_the_same_file(void **state) {
    place *p = *state;
    shader_binary binary;
    char link[PATH_CAP];
    place_write(p, "program/a.comp",
                "#include \"b.glsl\"\n#include \"l.glsl\"\n" COLOR STORE("b()"));
    place_write(p, "program/b.glsl", "float b() { return 1.0; }\n");
    assert_true(path_join(link, p->program, "l.glsl"));
    assert_int_equal(symlink("b.glsl", link), 0);
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_int_equal(binary.file_count, 2);
}

static void a_cycle_is_reported_as_a_chain(void **state) {
    place *p = *state;
    char chain[512];
    place_write(p, "program/a.comp", "#include \"b.glsl\"\nvoid main() {}\n");
    place_write(p, "program/b.glsl", "\n#include \"c.glsl\"\n");
    place_write(p, "program/c.glsl", "\n\n#include \"a.comp\"\n");
    snprintf(chain, sizeof chain,
             "%s/c.glsl:3: include cycle: %s/a.comp -> %s/b.glsl -> %s/c.glsl -> %s/a.comp",
             p->program, p->program, p->program, p->program, p->program);
    place_refuses(p, "a.comp", chain);
    place_write(p, "program/self.comp", "#include \"self.comp\"\n");
    place_refuses(p, "self.comp", "self.comp:1: include cycle: ");
}

static void a_missing_file_names_its_includer(void **state) {
    place *p = *state;
    place_write(p, "effect/a.comp", "// x\n#include \"b.glsl\"\nvoid main() {}\n");
    place_write(p, "effect/b.glsl", "\n\n#include \"nothing.glsl\"\n");
    place_refuses(p, "a.comp", "effect/b.glsl:3: include file \"nothing.glsl\" not found");
    assert_error(p->effect);
    assert_error(p->program);
    place_refuses(p, "nothing.comp", "nothing.comp: no such shader; looked in ");
}

static void nothing_outside_the_folders_is_read(void **state) {
    place *p = *state;
    char link[PATH_CAP];
    place_write(p, "secret.glsl", "float secret;\n");
    place_write(p, "effect/up.comp", "#include \"../secret.glsl\"\nvoid main() {}\n");
    place_refuses(p, "up.comp", "up.comp:1: \"../secret.glsl\" leaves ");
    place_write(p, "effect/sub/up.comp", "#include \"../../secret.glsl\"\nvoid main() {}\n");
    place_refuses(p, "sub/up.comp", "leaves ");
    place_write(p, "effect/root.comp", "\n#include \"/etc/passwd\"\nvoid main() {}\n");
    place_refuses(p, "root.comp", "root.comp:2: \"/etc/passwd\" must be relative");
    assert_true(path_join(link, p->effect, "link.glsl"));
    assert_int_equal(symlink("../secret.glsl", link), 0);
    place_write(p, "effect/link.comp", "#include \"link.glsl\"\nvoid main() {}\n");
    place_refuses(p, "link.comp", "leads out of");
    assert_true(path_join(link, p->effect, "folder"));
    assert_int_equal(symlink("..", link), 0);
    place_write(p, "effect/folder.comp", "#include \"folder/secret.glsl\"\nvoid main() {}\n");
    place_refuses(p, "folder.comp", "leads out of");
    place_refuses(p, "../secret.glsl", "leaves ");
    place_refuses(p, "/etc/passwd", "must be relative");
    place_refuses(p, "", "no such shader");
}

// glslang would read these by itself, from anywhere, if it saw the directive.
static void no_disguise_brings_an_include_to_the_compiler(void **state) {
    static const char *const disguises[] = {
        "/* a\n*/ #include \"../secret.glsl\"\n",
        "/* a */ # /* b */ include /* c */ \"../secret.glsl\" // d\n",
        "\v\f#\vinclude\f\"../secret.glsl\"\n",
        "float x;\r#include \"../secret.glsl\"\r\n",
        "#\\\ninclude \"../secret.glsl\"\n",
        "#inc\\\nlude \"../secret.glsl\"\n",
        "#/\\\n* */ include \"../secret.glsl\"\n",
        "#import \"../secret.glsl\"\n",
    };
    place *p = *state;
    place_write(p, "secret.glsl", "float secret;\n");
    for (size_t i = 0; i < sizeof disguises / sizeof *disguises; i++) {
        char text[512];
        shader_binary binary;
        snprintf(text, sizeof text,
                 "#extension GL_GOOGLE_include_directive : enable\n%svoid main() { secret; }\n",
                 disguises[i]);
        place_write(p, "program/a.comp", text);
        assert_false(shader_compile(p->library, &p->memory,
                                    &(shader_compile_desc){.name = "a.comp"}, &binary));
        bool refused = strstr(err_get(), "leaves ") || strstr(err_get(), "unknown directive");
        if (!refused) fail_msg("%zu: %s", i, err_get());
    }
}

static void the_effects_folder_comes_first_for_the_effect_only(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/lib/x.glsl", "float x() { return 1.0; }\n");
    place_write(p, "program/pass/p.comp", "#include \"lib/x.glsl\"\n" COLOR STORE("x()"));
    place_write(p, "effect/lib/x.glsl", "float own() { return 2.0; }\n");
    place_write(p, "effect/u.comp", "#include \"lib/x.glsl\"\n" COLOR STORE("own()"));
    place_compile(p, &(shader_compile_desc){.name = "u.comp"}, &binary);
    place_compile(p, &(shader_compile_desc){.name = "pass/p.comp"}, &binary);
    place_write(p, "effect/v.comp", "#include \"lib/y.glsl\"\n" COLOR STORE("y()"));
    place_write(p, "program/lib/y.glsl", "float y() { return 1.0; }\n");
    place_compile(p, &(shader_compile_desc){.name = "v.comp"}, &binary);
}

static void generated_texts_are_found_and_can_include(void **state) {
    place *p = *state;
    shader_binary binary;
    const shader_text texts[] = {
        {"fields.glsl",
         "#include \"user.glsl\"\n#include \"more\"\nfloat f() { return user(); }\n"},
        {"more", "float more;\n"}};
    place_write(p, "program/a.comp", "#include \"fields.glsl\"\n" COLOR STORE("f() + more"));
    place_write(p, "effect/user.glsl", "float user() { return 1.0; }\n");
    place_write(p, "effect/fields.glsl", "#error a file does not replace a generated text\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp", .texts = texts, .text_count = 2},
                  &binary);
    assert_int_equal(binary.file_count, 2); // a.comp and user.glsl
}

static void missing_fields_matter_to_a_compile_only(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp",
                "//@ field float heat : x\n#include \"fields.glsl\"\nvoid main() { "
                "field_heat(vec3(0)); }\n");
    const shader_interface *interface =
        shader_interface_load(p->library, &p->memory, "a.comp", NULL);
    assert_non_null(interface);
    assert_int_equal(interface->field_count, 1);
    place_refuses(p, "a.comp", "a.comp:2: include file \"fields.glsl\" not found");
}

static void depth_is_limited(void **state) {
    place *p = *state;
    for (int i = 0; i < 40; i++) {
        char name[64], text[64];
        snprintf(name, sizeof name, "program/%d.glsl", i);
        snprintf(text, sizeof text, "#include \"%d.glsl\"\n", i + 1);
        place_write(p, name, i < 39 ? text : "void main() {}\n");
    }
    place_refuses(p, "0.glsl", "32.glsl:1: includes are nested more than 32 deep");
    shader_binary binary;
    place_compile(p, &(shader_compile_desc){.name = "8.glsl"}, &binary);
}

static void size_is_limited(void **state) {
    place *p = *state;
    enum { LINES = 30000, LINE = 100 };
    char *text = malloc(LINES * LINE + 1);
    memset(text, ' ', LINES * LINE);
    for (int i = 0; i < LINES; i++) text[i * LINE + LINE - 1] = '\n';
    text[LINES * LINE] = '\0';
    place_write(p, "program/b.glsl", text);
    place_write(p, "program/c.glsl", text);
    free(text);
    place_write(p, "program/a.comp", "#include \"b.glsl\"\n#include \"c.glsl\"\nvoid main() {}\n");
    place_refuses(p, "a.comp", "larger than 4 MiB");
}

static void malformed_directives_and_files_are_refused(void **state) {
    place *p = *state;
    static const char *const malformed[] = {"#include b\n", "#include \"b\n", "#include \"\"\n",
                                            "#include\n", "#include \"b\" c\n"};
    for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++) {
        place_write(p, "program/a.comp", malformed[i]);
        place_refuses(p, "a.comp", "a.comp:1: malformed #include");
    }
    place_write(p, "program/a.comp", "void main() {}\n/* open\n");
    place_refuses(p, "a.comp", "a.comp:2: a comment is not closed");
    char path[PATH_CAP];
    assert_true(path_join(path, p->program, "zero.comp"));
    assert_true(file_write(path, "void\0main", 9));
    place_refuses(p, "zero.comp", "zero byte");
    assert_true(path_join(path, p->program, "folder.comp"));
    assert_true(file_make_folders(path));
    place_refuses(p, "folder.comp", "no such shader");
}

static void comments_hide_includes(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "// #include \"x\"\n/* #include \"y\"\n#include \"z\"\n*/\nvoid main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_int_equal(binary.file_count, 1);
}

static void what_c_needs_is_ignored(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "#version 430\n#ifdef GL_core_profile\n#else\n#include <stdint.h>\n#endif\n"
                "void main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(includes_nest_and_follow_the_includer),
        PLACE_TEST(a_file_is_included_once),
        PLACE_TEST(a_link_to_an_included_file_is_the_same_file),
        PLACE_TEST(a_cycle_is_reported_as_a_chain),
        PLACE_TEST(a_missing_file_names_its_includer),
        PLACE_TEST(nothing_outside_the_folders_is_read),
        PLACE_TEST(no_disguise_brings_an_include_to_the_compiler),
        PLACE_TEST(the_effects_folder_comes_first_for_the_effect_only),
        PLACE_TEST(generated_texts_are_found_and_can_include),
        PLACE_TEST(missing_fields_matter_to_a_compile_only),
        PLACE_TEST(depth_is_limited),
        PLACE_TEST(size_is_limited),
        PLACE_TEST(malformed_directives_and_files_are_refused),
        PLACE_TEST(comments_hide_includes),
        PLACE_TEST(what_c_needs_is_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
