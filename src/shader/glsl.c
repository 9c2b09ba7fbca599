// GLSL to SPIR-V by glslang.
//
// Vulkan's rules are relaxed, so that glslang itself gathers loose uniforms into one block, in
// order of declaration. Its log is reduced to the first error, with the true file, line and the
// source line beneath. Once macros are expanded, statements of absurd length are refused: each
// operator is one more level of glslang's recursion.
#include "base/memory.h"
#include "shader/unit.h"
#include <ctype.h>
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <glslang/build_info.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_OPERATORS = 20000, // of one statement; a table of 5000 negative numbers has 10000
    MESSAGES = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT,
    OPTIONS = GLSLANG_SHADER_AUTO_MAP_BINDINGS | GLSLANG_SHADER_AUTO_MAP_LOCATIONS |
              GLSLANG_SHADER_VULKAN_RULES_RELAXED,
};

static pthread_once_t started = PTHREAD_ONCE_INIT;

static void start(void) {
    glslang_initialize_process();
}

uint32_t glsl_version(void) {
    return GLSLANG_VERSION_MAJOR * 10000 + GLSLANG_VERSION_MINOR * 100 + GLSLANG_VERSION_PATCH;
}

// ---- messages ---------------------------------------------------------------------------------

// "'' : text " and "'x' : text " -> "text" and "'x': text", one line.
static void tidy(const char *text, char *out, size_t capacity) {
    size_t length = strcspn(text, "\r\n");
    if (strncmp(text, "'' : ", 5) == 0) {
        text += 5;
        length -= 5;
    }
    while (length && isspace((unsigned char)*text)) {
        text++;
        length--;
    }
    while (length && isspace((unsigned char)text[length - 1])) length--;
    snprintf(out, capacity, "%.*s", (int)(length < 1000 ? length : 1000), text);
    char *colon = strstr(out, "' : ");
    if (out[0] == '\'' && colon) memmove(colon + 1, colon + 2, strlen(colon + 2) + 1);
}

// Turns the first message of `log` that contains `mark` ("ERROR: ") into the thread's error.
static bool fail_log(const shader_unit *unit, const char *log, const char *mark) {
    const char *label = unit->files[0].where.label, *found = strstr(log, mark);
    char message[1024], source[240];
    int file, line, begin = 0;
    const char *text = found ? found + strlen(mark) : log;
    if (sscanf(text, "%d:%d: %n", &file, &line, &begin) < 2 || !begin) {
        tidy(text, message, sizeof message);
        return err_set("%s: %s", label, message[0] ? message : "the compiler gave no reason");
    }
    tidy(text + begin, message, sizeof message);
    if (file < 1 || (size_t)file > unit->file_count)
        return err_set("%s: in what roil puts before it: %s", label, message);
    unit_source_line(unit, file - 1, line, source, sizeof source);
    label = unit->files[file - 1].where.label;
    return err_set("%s:%d: %s\n    %s", label, line, message, source);
}

// ---- stages of a compile ----------------------------------------------------------------------

// Operators between one `;` or brace and the next, at most. Dots of numbers do not count.
static size_t longest_statement(const char *code) {
    size_t longest = 0, count = 0;
    for (; *code; code++) {
        bool end = *code == ';' || *code == '{' || *code == '}';
        bool member = *code == '.' && (isalpha((unsigned char)code[1]) || code[1] == '_');
        count = end ? 0 : count + (member || strchr("+-*/%<>=!&|^?:,[~", *code) != NULL);
        if (count > longest) longest = count;
    }
    return longest;
}

static bool parse(const shader_unit *unit, glslang_shader_t *shader, const glslang_input_t *input) {
    static const char initialiser[] = "Ignoring initializer for uniform";
    glslang_shader_set_options(shader, OPTIONS);
    bool done = glslang_shader_preprocess(shader, input);
    if (done && longest_statement(glslang_shader_get_preprocessed_code(shader)) > MAX_OPERATORS)
        return err_set("%s: a statement has more than %d operators", unit->files[0].where.label,
                       MAX_OPERATORS);
    done = done && glslang_shader_parse(shader, input);
    const char *log = glslang_shader_get_info_log(shader);
    if (!done) return fail_log(unit, log, "ERROR: ");
    const char *ignored = strstr(log, initialiser);
    if (!ignored) return true;
    while (ignored > log && ignored[-1] != '\n') ignored--;
    fail_log(unit, ignored, "WARNING: ");
    return err_set("%s\n    a uniform takes its default from an annotation: //= value : help",
                   err_get());
}

static bool link_program(const shader_unit *unit, glslang_program_t *program) {
    if (glslang_program_link(program, MESSAGES) && glslang_program_map_io(program)) return true;
    return fail_log(unit, glslang_program_get_info_log(program), "ERROR: ");
}

static bool generate(const shader_unit *unit, glslang_program_t *program, glslang_stage_t stage,
                     spirv *out) {
    glslang_spv_options_t options = {.disable_optimizer = true};
    glslang_program_SPIRV_generate_with_options(program, stage, &options);
    size_t count = glslang_program_SPIRV_get_size(program);
    if (!count) return err_set("%s: no code was generated", unit->files[0].where.label);
    out->words = mem_copy(glslang_program_SPIRV_get_ptr(program), count * sizeof *out->words);
    out->count = count;
    return true;
}

bool glsl_compile(const shader_unit *unit, const char *source, shader_stage stage, spirv *out) {
    static const glslang_stage_t stages[] = {[SHADER_COMPUTE] = GLSLANG_STAGE_COMPUTE,
                                             [SHADER_VERTEX] = GLSLANG_STAGE_VERTEX,
                                             [SHADER_FRAGMENT] = GLSLANG_STAGE_FRAGMENT};
    pthread_once(&started, start);
    glslang_input_t input = {.language = GLSLANG_SOURCE_GLSL,
                             .stage = stages[stage],
                             .client = GLSLANG_CLIENT_VULKAN,
                             .client_version = GLSLANG_TARGET_VULKAN_1_3,
                             .target_language = GLSLANG_TARGET_SPV,
                             .target_language_version = GLSLANG_TARGET_SPV_1_6,
                             .code = source,
                             .default_version = 460,
                             .default_profile = GLSLANG_NO_PROFILE,
                             .messages = (glslang_messages_t)MESSAGES,
                             .resource = glslang_default_resource()};
    glslang_shader_t *shader = glslang_shader_create(&input);
    glslang_program_t *program = glslang_program_create();
    bool done = parse(unit, shader, &input);
    if (done) {
        glslang_program_add_shader(program, shader);
        done = link_program(unit, program) && generate(unit, program, input.stage, out);
    }
    glslang_program_delete(program);
    glslang_shader_delete(shader);
    return done;
}

// ---- warming up -------------------------------------------------------------------------------

static pthread_once_t warmed = PTHREAD_ONCE_INIT;
static pthread_t warmer;

static void *warm(void *unused) {
    char text[] = "#version 460\nvoid main() {}\n";
    unit_file file = {.where = {.name = "warm", .label = "warm"},
                      .text = text,
                      .size = sizeof text - 1,
                      .includer = -1};
    shader_unit unit = {.files = &file, .file_count = 1};
    spirv code = {0};
    if (glsl_compile(&unit, text, SHADER_COMPUTE, &code)) mem_free(code.words);
    return unused;
}

// The thread must not outlive glslang's static objects, which die after this handler.
static void join_warmer(void) {
    pthread_join(warmer, NULL);
}

static void start_warmer(void) {
    if (pthread_create(&warmer, NULL, warm, NULL) == 0) atexit(join_warmer);
}

void shader_warm_up(void) {
    pthread_once(&warmed, start_warmer);
}
