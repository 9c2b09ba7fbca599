// Compiling: options, defines, toggles, counters, stages, messages, threads; the code is valid.
#include "base/isolate.h"
#include "shader/unit.h"
#include "shader_helper.h"
#include <pthread.h>

static void assert_valid(const shader_binary *binary) {
    const spirv code = {.words = (uint32_t *)binary->code, .count = binary->size / 4};
    if (!spirv_validate(&code)) fail_msg("%s", err_get());
}

static const char everything[] = "//@ option mode = fine {coarse, fine} : how\n"
                                 "//@ counter samples : evaluations\n"
                                 "//@ counter rays : rays\n"
                                 "uniform float strength; //= 0.2 [0, 1] : x\n"
                                 "uniform int kind; //= soft {hard, soft} : x\n"
                                 "uniform bool invert; //= false : x\n"
                                 "uniform sampler2D input_; //= input : x\n"
                                 "uniform sampler2D never; //= input optional : never used\n"
                                 "writeonly uniform image2D color; //= output rgba16f : x\n"
                                 "void main() {\n"
                                 "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                 "    vec4 value = texelFetch(input_, at, 0) * strength;\n"
                                 "    if (invert) value = -value;\n"
                                 "    if (kind == KIND_SOFT) value *= 0.5;\n"
                                 "#if MODE == MODE_FINE && MODE_COARSE == 0\n"
                                 "    value.r = 1;\n"
                                 "#else\n"
                                 "    value = imageSize(color).xyxy;\n"
                                 "#endif\n"
                                 "    count_samples(at.x);\n"
                                 "    count_rays(1u);\n"
                                 "    imageStore(color, at, value);\n"
                                 "}\n";

static void everything_at_once_is_valid_code(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp", everything);
    for (int counters = 0; counters < 2; counters++) {
        place_compile(p, &(shader_compile_desc){.name = "a.comp", .counters = counters}, &binary);
        assert_valid(&binary);
        assert_null(find_slot(&binary, "never"));
        assert_int_equal(find_slot(&binary, "Counters") != NULL, counters);
    }
}

static void counters_cost_nothing_when_off(void **state) {
    place *p = *state;
    shader_binary with, without;
    place_write(p, "program/a.comp", "//@ counter n : x\nvoid main() { count_n(3); }\n");
    place_write(p, "program/b.comp", "void main() { ; }\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &with);
    place_compile(p, &(shader_compile_desc){.name = "b.comp"}, &without);
    assert_int_equal(with.size, without.size);
    assert_memory_equal(with.code, without.code, with.size);
    place_write(p, "program/c.comp", "#if ROIL_COUNTERS\n#error on\n#endif\nvoid main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "c.comp"}, &with);
    assert_false(shader_compile(p->library, &p->memory,
                                &(shader_compile_desc){.name = "c.comp", .counters = true}, &with));
}

static void options_choose_code(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "//@ option first = a {a, b} : x\n//@ option mode = one {one, two, three} : x\n"
                "#if MODE == MODE_THREE && FIRST == FIRST_B\n#error chosen\n#endif\n"
                "void main() {}\n");
    const size_t chosen[] = {1, 2}, other[] = {1, 1}, wrong[] = {0, 3};
    shader_compile_desc desc = {.name = "a.comp"};
    place_compile(p, &desc, &binary);
    desc.options = other;
    desc.option_count = 1;
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("has 2 options, values of 1 were given");
    desc.option_count = 2;
    place_compile(p, &desc, &binary);
    desc.options = chosen;
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("a.comp:4: '#error': chosen");
    desc.options = wrong;
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("option mode has 3 words, number 3");
}

static void defines_reach_the_text_and_are_checked(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "writeonly uniform image2D color; //= output rgba16f : x\n"
                "void main() { imageStore(color, ivec2(0), vec4(VALUE)); }\n");
    shader_define defines[] = {{"VALUE", "1.5"}, {"FORMAT_COLOR", "r32f"}};
    shader_compile_desc desc = {.name = "a.comp", .defines = defines, .define_count = 2};
    place_compile(p, &desc, &binary);
    place_refuses(p, "a.comp", "'VALUE': undeclared identifier");
    defines[1].value = "nonsense";
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("a.comp:1: ");
    defines[1].value = "1\n#include \"x\"";
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("cannot be defined");
    defines[1] = (shader_define){"not a name", "1"};
    assert_false(shader_compile(p->library, &p->memory, &desc, &binary));
    assert_error("cannot be defined");
}

static void vertex_and_fragment_share_a_set_of_bindings(void **state) {
    place *p = *state;
    shader_binary vertex, fragment;
    place_write(p, "program/a.vert",
                "uniform mat4 view;\nlayout(location = 0) out vec2 at;\n"
                "void main() { at = vec2(gl_VertexIndex);\n"
                "gl_Position = view * vec4(at, 0, 1); }\n");
    place_write(p, "program/a.frag",
                "uniform sampler2D input_; //= input : x\nuniform float gain; //= 1 : x\n"
                "layout(location = 0) in vec2 at;\nout vec4 color; //= output rgba16f : x\n"
                "void main() { color = gain * texture(input_, at); }\n");
    place_compile(p, &(shader_compile_desc){.name = "a.vert", .stage = SHADER_VERTEX}, &vertex);
    place_compile(p, &(shader_compile_desc){.name = "a.frag", .stage = SHADER_FRAGMENT}, &fragment);
    assert_valid(&vertex);
    assert_valid(&fragment);
    assert_int_equal(vertex.slot_count, 1);
    assert_int_equal(fragment.slot_count, 2);
    for (size_t i = 0; i < 2; i++)
        assert_int_not_equal(vertex.slots[0].slot.binding, fragment.slots[i].slot.binding);
    assert_int_equal(find_member(&vertex, "view")->type, SHADER_MAT4);
}

static void a_message_names_the_included_file_its_line_and_shows_it(void **state) {
    place *p = *state;
    char expected[256];
    place_write(p, "program/lib/b.glsl", "float b() {\n\n    return nothing; // here\n}\n");
    place_write(p, "program/a.comp", "\n#include \"lib/b.glsl\"\nvoid main() { b(); }\n");
    snprintf(expected, sizeof expected,
             "%s/lib/b.glsl:3: 'nothing': undeclared identifier\n    return nothing; // here",
             p->program);
    place_refuses(p, "a.comp", expected);
    assert_null(strstr(err_get(), "ERROR"));
    place_write(p, "program/lib/b.glsl", "float b() { return 1; }\n");
    place_write(p, "program/c.comp",
                "\n#include \"lib/b.glsl\"\n/* two\nlines */ void main() {\n  b() }\n");
    place_refuses(p, "c.comp", "c.comp:5: syntax error");
    const shader_text texts[] = {{"fields.glsl", "\nfloat f() { return x; }\n"}};
    place_write(p, "program/d.comp", "#include \"fields.glsl\"\nvoid main() { f(); }\n");
    shader_binary binary;
    assert_false(shader_compile(
        p->library, &p->memory,
        &(shader_compile_desc){.name = "d.comp", .texts = texts, .text_count = 1}, &binary));
    assert_error("fields.glsl:2: 'x': undeclared identifier");
}

static void messages_without_a_line_name_the_file(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", "void other() {}\n");
    place_refuses(p, "a.comp", "program/a.comp: Linking compute stage: Missing entry point");
    place_write(p, "program/b.comp",
                "uniform mat3 m;\nwriteonly uniform image2D c; //= output "
                "r32f : x\nvoid main() { imageStore(c, ivec2(0), m[0].xyzz); }\n");
    place_refuses(p, "b.comp", "b.comp: uniform m: this type is not supported");
    place_write(p, "program/c.comp",
                "uniform samplerCube s;\nwriteonly uniform image2D c; //= output "
                "r32f : x\nvoid main() { imageStore(c, ivec2(0), texture(s, vec3(1))); }\n");
    place_refuses(p, "c.comp", "c.comp: s: only 2D and 3D images");
}

static void an_initialiser_of_a_uniform_is_refused(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp", "\nuniform float x = 2.0;\nvoid main() { float y = x; }\n");
    place_refuses(p, "a.comp", "a.comp:2: ");
    assert_error("//= value : help");
}

static void absurd_statements_are_refused(void **state) {
    place *p = *state;
    enum { TERMS = 100000 };
    char *text = malloc(2 * TERMS + 100), *at = text;
    at += sprintf(at, "void main() { int a = 1");
    for (int i = 0; i < TERMS; i++) at += sprintf(at, "+1");
    sprintf(at, "; }\n");
    place_write(p, "program/a.comp", text);
    free(text);
    place_refuses(p, "a.comp", "more than 20000 operators");
    char bomb[1024]; // short as a text
    at = bomb + sprintf(bomb, "#define A0 1+1+1+1+1+1+1+1\n");
    for (int i = 1; i < 6; i++)
        at += sprintf(at, "#define A%d A%d+A%d+A%d+A%d+A%d+A%d+A%d+A%d\n", i, i - 1, i - 1, i - 1,
                      i - 1, i - 1, i - 1, i - 1, i - 1);
    sprintf(at, "void main() { int a = A5; }\n");
    place_write(p, "program/b.comp", bomb);
    place_refuses(p, "b.comp", "more than 20000 operators");
}

static void nesting_and_calls_do_not_overflow_the_stack(void **state) {
    place *p = *state;
    shader_binary binary;
    enum { DEPTH = 3000 };
    char *text = malloc(DEPTH * 64), *at = text;
    at += sprintf(at, "writeonly uniform image2D c; //= output r32f : x\n"
                      "void f0() { imageStore(c, ivec2(0), vec4(1)); }\n");
    for (int i = 1; i < DEPTH; i++) at += sprintf(at, "void f%d() { f%d(); }\n", i, i - 1);
    sprintf(at, "void main() { f%d(); }\n", DEPTH - 1);
    place_write(p, "program/a.comp", text);
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    at = text + sprintf(text, "void main() { float a = 1; a = ");
    for (int i = 0; i < 19000; i++) at += sprintf(at, "a+");
    sprintf(at, "a; }\n");
    place_write(p, "program/b.comp", text);
    place_compile(p, &(shader_compile_desc){.name = "b.comp"}, &binary);
    free(text);
}

static void *compile_many(void *user) {
    place *p = user;
    arena memory = {0};
    size_t failed = 0;
    for (int i = 0; i < 8; i++) {
        char value[16];
        shader_binary binary;
        snprintf(value, sizeof value, "%d", i % 4);
        const shader_define define = {"VALUE", value};
        shader_compile_desc desc = {
            .name = i & 1 ? "a.comp" : "wrong.comp", .defines = &define, .define_count = 1};
        bool done = shader_compile(p->library, &memory, &desc, &binary);
        failed += i & 1 ? !done : done || !strstr(err_get(), "wrong.comp:1: ");
    }
    arena_free(&memory);
    return failed ? user : NULL;
}

static void threads_compile_side_by_side(void **state) {
    place *p = *state;
    pthread_t threads[4];
    place_write(p, "program/a.comp", everything);
    place_write(p, "program/wrong.comp", "void main() { x }\n");
    isolate_warm_up("glsl");
    isolate_warm_up("glsl");
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, compile_many, p), 0);
    for (int i = 0; i < 4; i++) {
        void *failed;
        pthread_join(threads[i], &failed);
        assert_null(failed);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(everything_at_once_is_valid_code),
        PLACE_TEST(counters_cost_nothing_when_off),
        PLACE_TEST(options_choose_code),
        PLACE_TEST(defines_reach_the_text_and_are_checked),
        PLACE_TEST(vertex_and_fragment_share_a_set_of_bindings),
        PLACE_TEST(a_message_names_the_included_file_its_line_and_shows_it),
        PLACE_TEST(messages_without_a_line_name_the_file),
        PLACE_TEST(an_initialiser_of_a_uniform_is_refused),
        PLACE_TEST(absurd_statements_are_refused),
        PLACE_TEST(nesting_and_calls_do_not_overflow_the_stack),
        PLACE_TEST(threads_compile_side_by_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
