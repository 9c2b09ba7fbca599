// GLSL to SPIR-V by glslang, in this process: compiler_work.c runs it where it can do no harm.
//
// Vulkan's rules are relaxed, so that glslang itself gathers loose uniforms into one block, in
// order of declaration. Once macros are expanded, statements of extreme length are refused, because
// each operator is one more level of glslang's recursion.
#include "shader/unit.h"
#include <ctype.h>
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <pthread.h>
#include <string.h>

enum {
    MESSAGES = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT,
    OPTIONS = GLSLANG_SHADER_AUTO_MAP_BINDINGS | GLSLANG_SHADER_AUTO_MAP_LOCATIONS |
              GLSLANG_SHADER_VULKAN_RULES_RELAXED,
};

static pthread_once_t started = PTHREAD_ONCE_INIT;

static void glslang_start(void) {
    glslang_initialize_process();
}

static glsl_answer with_log(glsl_outcome outcome, const char *log) {
    return (glsl_answer){.outcome = outcome, .data = (char *)log, .size = strlen(log)};
}

// Returns the greatest number of operators between two of `;` and braces. Dots of numbers do not
// count.
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

static glsl_answer glsl_parse(glslang_shader_t *shader, const glslang_input_t *input) {
    static const char initialiser[] = "Ignoring initializer for uniform";
    glslang_shader_set_options(shader, OPTIONS);
    if (!glslang_shader_preprocess(shader, input))
        return with_log(GLSL_REFUSED, glslang_shader_get_info_log(shader));
    if (longest_statement(glslang_shader_get_preprocessed_code(shader)) > GLSL_MAX_OPERATORS)
        return with_log(GLSL_LONG_STATEMENT, "");
    bool done = glslang_shader_parse(shader, input);
    const char *log = glslang_shader_get_info_log(shader);
    if (!done) return with_log(GLSL_REFUSED, log);
    const char *ignored = strstr(log, initialiser);
    if (!ignored) return (glsl_answer){.outcome = GLSL_DONE};
    while (ignored > log && ignored[-1] != '\n') ignored--;
    return with_log(GLSL_INITIALISER, ignored);
}

static glsl_answer glsl_generate(glslang_program_t *program, glslang_stage_t stage) {
    if (!glslang_program_link(program, MESSAGES) || !glslang_program_map_io(program))
        return with_log(GLSL_REFUSED, glslang_program_get_info_log(program));
    glslang_spv_options_t options = {.disable_optimizer = true};
    glslang_program_SPIRV_generate_with_options(program, stage, &options);
    size_t count = glslang_program_SPIRV_get_size(program);
    if (!count) return with_log(GLSL_NO_CODE, "");
    if (count > SPIRV_MAX_SIZE / sizeof(uint32_t)) return with_log(GLSL_LARGE, "");
    return (glsl_answer){.outcome = GLSL_DONE,
                         .data = glslang_program_SPIRV_get_ptr(program),
                         .size = count * sizeof(uint32_t)};
}

void glsl_run(const char *source, shader_stage stage, glsl_receiver *receive, void *user) {
    static const glslang_stage_t stages[] = {[SHADER_COMPUTE] = GLSLANG_STAGE_COMPUTE,
                                             [SHADER_VERTEX] = GLSLANG_STAGE_VERTEX,
                                             [SHADER_FRAGMENT] = GLSLANG_STAGE_FRAGMENT};
    pthread_once(&started, glslang_start);
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
    glsl_answer answer = glsl_parse(shader, &input);
    if (answer.outcome == GLSL_DONE) {
        glslang_program_add_shader(program, shader);
        answer = glsl_generate(program, input.stage);
    }
    receive(user, &answer);
    glslang_program_delete(program);
    glslang_shader_delete(shader);
}
