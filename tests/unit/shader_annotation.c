// Annotations: every form that is accepted, and every error with its line.
#include "shader_helper.h"
#include <math.h>

static const shader_interface *load(place *p, const char *text) {
    place_write(p, "program/a.comp", text);
    const shader_interface *interface =
        shader_interface_load(p->library, &p->memory, "a.comp", NULL);
    if (!interface) fail_msg("%s", err_get());
    return interface;
}

// Line 2 of the file is `line`.
static void refuses(place *p, const char *line, const char *part) {
    char text[1024];
    snprintf(text, sizeof text, "// x\n%s\nvoid main() {}\n", line);
    place_write(p, "program/a.comp", text);
    err_clear();
    if (shader_interface_load(p->library, &p->memory, "a.comp", NULL))
        fail_msg("accepted: %s", line);
    assert_error("program/a.comp:2: ");
    assert_error(part);
}

static void numbers_have_defaults_ranges_units_and_help(void **state) {
    const shader_interface *i =
        load(*state, "uniform float strength; //= 0.2 [0, 1] m : how far: a ray \n"
                     "uniform vec3 tint; //= {1, 0.9, 0.8} color : of air\n"
                     "uniform vec2 both; //= -3e1 [-inf, 0]:x\n"
                     "uniform vec4 any; //= .5 [-1, inf] 1/m : y\n"
                     "uniform int count; //= 8 [1, 16] : z\n"
                     "uniform uint seed; //= 7 : s\n");
    assert_int_equal(i->uniform_count, 6);
    const value_desc *u = i->uniforms;
    assert_string_equal(u[0].name, "strength");
    assert_int_equal(u[0].type, VALUE_NUMBER);
    assert_float_equal(u[0].value[0], 0.2f, 0);
    assert_float_equal(u[0].min, 0, 0);
    assert_float_equal(u[0].max, 1, 0);
    assert_string_equal(u[0].unit, "m");
    assert_string_equal(u[0].help, "how far: a ray");
    assert_true(u[1].type == VALUE_COLOR && u[1].components == 3);
    assert_float_equal(u[1].value[2], 0.8f, 0);
    assert_true(isinf(u[1].min) && u[1].min < 0 && isinf(u[1].max));
    assert_string_equal(u[1].unit, "");
    assert_float_equal(u[2].value[1], -30, 0); // one number is every component
    assert_true(isinf(u[2].min) && u[2].max == 0);
    assert_string_equal(u[3].unit, "1/m");
    assert_float_equal(u[3].value[3], 0.5f, 0);
    assert_true(isinf(u[3].max));
    assert_int_equal(u[4].type, VALUE_WHOLE);
    assert_int_equal(u[5].type, VALUE_WHOLE);
    assert_float_equal(u[5].min, 0, 0);
}

static void words_make_toggles_and_enumerations(void **state) {
    const shader_interface *i = load(*state, "uniform int kind_; //= soft {hard, soft} : an enum\n"
                                             "uniform bool invert; //= true : a toggle\n");
    assert_string_equal(i->uniforms[0].name, "kind");
    assert_int_equal(i->uniforms[0].type, VALUE_WORD);
    assert_int_equal(i->uniforms[0].word_count, 2);
    assert_string_equal(i->uniforms[0].words[1], "soft");
    assert_float_equal(i->uniforms[0].value[0], 1, 0);
    assert_int_equal(i->uniforms[1].type, VALUE_BOOL);
    assert_float_equal(i->uniforms[1].value[0], 1, 0);
}

static void images_are_inputs_outputs_and_histories(void **state) {
    const shader_interface *i =
        load(*state, "uniform sampler2D input_; //= input : the picture\n"
                     "uniform sampler3D mask; //= input optional : a volume (missing: all)\n"
                     "uniform sampler2D last; //= input history color : before\n"
                     "layout(binding = 3) writeonly uniform image2D color; //= output rgba16f : o\n"
                     "layout(r32ui) uniform uimage3D cells; //= output r32ui optional : c\n");
    assert_int_equal(i->image_count, 5);
    const shader_image *m = i->images;
    assert_string_equal(m[0].name, "input");
    assert_string_equal(m[0].glsl_name, "input_");
    assert_true(!m[0].output && !m[0].optional && !m[0].volume && !m[0].history);
    assert_true(m[1].optional && m[1].volume);
    assert_string_equal(m[1].help, "a volume (missing: all)");
    assert_true(m[2].history);
    assert_string_equal(m[2].history_of, "color");
    assert_true(m[3].output && m[3].format == GPU_RGBA16F);
    assert_true(m[4].output && m[4].volume && m[4].optional && m[4].format == GPU_R32U);
}

static void a_fragment_target_is_an_output(void **state) {
    place *p = *state;
    place_write(p, "program/a.frag",
                "layout(location = 0) out vec4 color; //= output rgba8 : x\n"
                "void main() { color = vec4(1); }\n");
    const shader_interface *i = shader_interface_load(p->library, &p->memory, "a.frag", NULL);
    assert_non_null(i);
    assert_int_equal(i->images[0].format, GPU_RGBA8);
    shader_binary binary;
    place_compile(p, &(shader_compile_desc){.name = "a.frag", .stage = SHADER_FRAGMENT}, &binary);
}

static void options_fields_and_counters_stand_alone(void **state) {
    const shader_interface *i = load(*state, "//@ option mode = fine {coarse, fine, 2d} : how\n"
                                             "  //@ field float heat = 0.5 : excess\n"
                                             "//@ field vec3 glow after heat = {1, 2, 3} : g\n"
                                             "//@ field vec4 all = 1 after heat : a\n"
                                             "//@ field float must : m\n"
                                             "//@ counter samples : evaluations\n");
    assert_int_equal(i->option_count, 1);
    assert_string_equal(i->options[0].name, "mode");
    assert_int_equal(i->options[0].word_count, 3);
    assert_int_equal((int)i->options[0].value[0], 1);
    assert_int_equal(i->field_count, 4);
    assert_false(i->fields[0].required);
    assert_float_equal(i->fields[0].value[0], 0.5f, 0);
    assert_string_equal(i->fields[0].after, "");
    assert_string_equal(i->fields[1].after, "heat");
    assert_int_equal(i->fields[1].components, 3);
    assert_string_equal(i->fields[1].glsl_type, "vec3");
    assert_float_equal(i->fields[1].value[2], 3, 0);
    assert_float_equal(i->fields[2].value[3], 1, 0);
    assert_string_equal(i->fields[2].after, "heat");
    assert_true(i->fields[3].required);
    assert_int_equal(i->counter_count, 1);
    assert_string_equal(i->counters[0].help, "evaluations");
}

static void the_leading_comment_is_the_summary(void **state) {
    const shader_interface *i = load(*state, "// Bends the picture\r\n// where air is hot.\r\n"
                                             "//\r\n// More.\r\n//@ counter n : x\r\n");
    assert_string_equal(i->summary, "Bends the picture where air is hot.");
    assert_string_equal(load(*state, "void main() {}\n// no\n")->summary, "");
    assert_string_equal(load(*state, "// a\n//@ counter n : x\n")->summary, "a");
}

static void included_files_are_annotated_too(void **state) {
    place *p = *state;
    place_write(p, "program/lib/b.glsl", "\nuniform float inner; //= 1 : in\n");
    const shader_interface *i =
        load(p, "#include \"lib/b.glsl\"\nuniform float outer; //= 2 : o\n");
    assert_int_equal(i->uniform_count, 2);
    assert_string_equal(i->uniforms[0].name, "inner");
    place_write(p, "program/lib/b.glsl", "\nuniform float inner; //= x\n");
    assert_null(shader_interface_load(p->library, &p->memory, "a.comp", NULL));
    assert_error("lib/b.glsl:2: ");
}

static void ordinary_comments_are_no_annotations(void **state) {
    const shader_interface *i = load(*state, "//====== a title\n//@param x\n"
                                             "/* uniform float a; //= 1 : x\n//@ option z\n*/\n"
                                             "float b; // = 2 : y\n//\n//=\n");
    assert_int_equal(i->uniform_count + i->option_count, 0);
}

static void malformed_uniforms_are_refused(void **state) {
    static const char *const cases[][2] = {
        {"uniform float a; //= : x", "expected a number"},
        {"uniform float a; //= 1", "expected \": help\""},
        {"uniform float a; //= 1 :", "help after the colon is missing"},
        {"uniform float a; //= 1 :   ", "help after the colon is missing"},
        {"uniform float a; //= 1x : x", "is not a number"},
        {"uniform float a; //= 1e99 : x", "is not a number"},
        {"uniform float a; //= inf : x", "expected a number"},
        {"uniform float a; //= 2 [0, 1] : x", "default 2 is outside its range [0, 1]"},
        {"uniform vec2 a; //= {0, -1} [0, 1] : x", "default -1 is outside"},
        {"uniform float a; //= 1 [2, 0] : x", "range is empty"},
        {"uniform float a; //= 1 [0 2] : x", "expected ,"},
        {"uniform float a; //= 1 [0, 2 : x", "expected ]"},
        {"uniform float a; //= 1 m s : x", "expected \": help\""},
        {"uniform vec3 a; //= {1, 2} : x", "2 numbers given, 3 accepted"},
        {"uniform vec2 a; //= {1, 2, 3} : x", "3 numbers given, 2 accepted"},
        {"uniform vec2 a; //= {1, 2 : x", "expected , or }"},
        {"uniform int a; //= 1.5 : x", "whole numbers"},
        {"uniform int a; //= 1 [0.5, 2] : x", "whole numbers"},
        {"uniform int a; //= 33554433 : x", "whole numbers"},
        {"uniform uint a; //= 1 [-1, 2] : x", "cannot be negative"},
        {"uniform int a; //= soft : x", "expected {the words"},
        {"uniform int a; //= soft {} : x", "expected a word"},
        {"uniform int a; //= soft {hard, mild} : x", "\"soft\" is not in the list"},
        {"uniform int a; //= soft {soft, soft} : x", "\"soft\" is given twice"},
        {"uniform int a; //= soft {soft mild} : x", "expected , or }"},
        {"uniform bool a; //= 1 : x", "expected true or false"},
        {"uniform float a; //= soft {soft} : x", "expected a number"},
        {"uniform mat4 a; //= 1 : x", "only uniforms of type"},
        {"uniform float a[2]; //= 1 : x", "no arrays"},
        {"uniform float a, b; //= 1 : x", "declares one name"},
        {"uniform float a = 1; //= 1 : x", "without initialiser"},
        {"uniform float a //= 1 : x", "expected ;"},
        {"uniform float a; float b; //= 1 : x", "must follow its ;"},
        {"float a; //= 1 : x", "must follow `uniform TYPE NAME;`"},
        {"//= 1 : x", "must follow `uniform TYPE NAME;`"},
        {"uniform; //= 1 : x", "must follow `uniform TYPE NAME;`"},
        {"out float a; //= 1 : x", "only uniforms"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuses(*state, cases[i][0], cases[i][1]);
}

static void malformed_images_are_refused(void **state) {
    static const char *const cases[][2] = {
        {"uniform image2D a; //= output rgba17f : x", "unknown format \"rgba17f\""},
        {"uniform image2D a; //= output : x", "expected a format"},
        {"uniform image2D a; //= output rgba8_srgb : x", "unknown format"},
        {"uniform image2D a; //= output r32ui : x", "image2D does not hold r32ui"},
        {"uniform uimage2D a; //= output r32f : x", "uimage2D does not hold r32f"},
        {"layout(r32f) uniform image2D a; //= output rgba8 : x", "layout says r32f"},
        {"uniform image2D a; //= input : x", "an input is a uniform sampler2D"},
        {"uniform sampler2D a; //= output rgba8 : x", "an output is a uniform image2D"},
        {"uniform sampler2D a[2]; //= input : x", "no array"},
        {"uniform float a; //= input : x", "this is float"},
        {"uniform samplerCube a; //= input : x", "this is samplerCube"},
        {"uniform sampler2D a; //= input optinal : x", "unknown word \"optinal\""},
        {"uniform sampler2D a; //= input history : x", "the output whose last frame"},
        {"uniform sampler2D a; //= input", "expected optional, history"},
        {"uniform image2D a; //= output rgba8 history b : x", "unknown word \"history\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuses(*state, cases[i][0], cases[i][1]);
    place *p = *state;
    place_write(p, "program/a.comp", "uniform sampler2D a; //= input history b : x\n");
    assert_null(shader_interface_load(p->library, &p->memory, "a.comp", NULL));
    assert_error("no output \"b\"");
}

static void malformed_directives_are_refused(void **state) {
    static const char *const cases[][2] = {
        {"//@ optoin a = b {b} : x", "did you mean option?"},
        {"//@ elephant a = b {b} : x", "accepted are option, field, counter"},
        {"//@ : x", "expected option, field or counter"},
        {"//@ option", "the option's name"},
        {"//@ option a {b} : x", "expected ="},
        {"//@ option a = b : x", "expected {the words"},
        {"//@ option a = c {b} : x", "\"c\" is not in the list"},
        {"//@ option a = b {b, b} : x", "given twice"},
        {"//@ option a = b {b}", "expected \": help\""},
        {"//@ option 2 = b {b} : x", "cannot begin with a digit"},
        {"//@ field double a : x", "accepted are float, vec3, vec4"},
        {"//@ field float : x", "the field's name"},
        {"//@ field float a = : x", "expected a number"},
        {"//@ field vec3 a = {1, 2} : x", "2 numbers given, 3 accepted"},
        {"//@ field vec3 a after b : x", "no field \"b\" stands above"},
        {"//@ field vec3 a before b : x", "unknown word \"before\""},
        {"//@ field vec3 a", "expected = value, after NAME"},
        {"uniform vec4 a; //= {1, 1, 1, 1} color : x", "a: a color is a vec3"},
        {"//@ counter : x", "the counter's name"},
        {"//@ counter a", "expected \": help\""},
        {"float a; //@ counter a : x", "line of its own"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuses(*state, cases[i][0], cases[i][1]);
}

static void names_are_used_once(void **state) {
    static const char *const lines[] = {
        "uniform float same; //= 1 : x", "//@ option same = a {a} : x", "//@ field float same : x",
        "uniform sampler2D same; //= input : x", "uniform float same_; //= 1 : x"};
    place *p = *state;
    for (size_t i = 0; i < 5; i++) {
        for (size_t j = 0; j < 5; j++) {
            char text[256];
            snprintf(text, sizeof text, "%s\n%s\n", lines[i], lines[j]);
            place_write(p, "program/a.comp", text);
            assert_null(shader_interface_load(p->library, &p->memory, "a.comp", NULL));
            assert_error("a.comp:2: ");
            assert_error("same: there is already a");
        }
    }
    place_write(p, "program/a.comp", "//@ counter n : x\n//@ counter n : x\n");
    assert_null(shader_interface_load(p->library, &p->memory, "a.comp", NULL));
    assert_error("already a counter");
    load(p, "//@ counter n : x\nuniform int n; //= 1 : x\n"); // counters have names of their own
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(numbers_have_defaults_ranges_units_and_help),
        PLACE_TEST(words_make_toggles_and_enumerations),
        PLACE_TEST(images_are_inputs_outputs_and_histories),
        PLACE_TEST(a_fragment_target_is_an_output),
        PLACE_TEST(options_fields_and_counters_stand_alone),
        PLACE_TEST(the_leading_comment_is_the_summary),
        PLACE_TEST(included_files_are_annotated_too),
        PLACE_TEST(ordinary_comments_are_no_annotations),
        PLACE_TEST(malformed_uniforms_are_refused),
        PLACE_TEST(malformed_images_are_refused),
        PLACE_TEST(malformed_directives_are_refused),
        PLACE_TEST(names_are_used_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
