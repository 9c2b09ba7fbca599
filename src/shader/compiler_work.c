// In the reader: compiles, validates and reflects.
#include "base/memory.h"
#include "shader/compiler.h"
#include <string.h>
#include <unistd.h>

typedef struct task {
    const isolate_call *call; // NULL: to get ready
    compiler_order order;
} task;

static void compiler_rehearse(const glsl_answer *answer, shader_stage stage) {
    arena memory = {0};
    shader_binary binary;
    spirv code = {.words = mem_copy(answer->data, answer->size),
                  .count = answer->size / sizeof *code.words};
    spirv_reflect(&code, stage, &memory, &binary);
    mem_free(code.words);
    arena_free(&memory);
}

static _Noreturn void compiler_leave(const isolate_call *call, const glsl_answer *answer) {
    const compiler_answer head = {.outcome = answer->outcome, .size = answer->size};
    bool done =
        isolate_put(call, &head, sizeof head) && isolate_put(call, answer->data, answer->size);
    _exit(done ? 0 : 1); // sooner than glslang has freed its trees
}

static void answer_and_leave(void *user, const glsl_answer *answer) {
    const task *t = user;
    bool done = answer->outcome == GLSL_DONE;
    const spirv code = {.words = answer->data, .count = answer->size / sizeof *code.words};
    if (done && t->order.strange && !spirv_validate(&code)) {
        const char *why = err_get();
        compiler_leave(t->call, &(glsl_answer){GLSL_INVALID, (char *)why, strlen(why)});
    }
    if (done) compiler_rehearse(answer, t->order.stage);
    if (t->call) compiler_leave(t->call, answer);
}

bool compiler_work(const isolate_call *call) {
    task t = {.call = call};
    if (call->argument_size != sizeof t.order) return err_set("no order");
    memcpy(&t.order, call->arguments, sizeof t.order);
    if ((unsigned)t.order.stage > SHADER_FRAGMENT) return err_set("no such stage");
    glsl_run(call->bytes, t.order.stage, answer_and_leave, &t);
    return err_set("no answer");
}

void compiler_get_ready(void) {
    static const char source[] = "#version 460\nlayout(r32f) uniform image2D image;\n"
                                 "uniform float value;\n"
                                 "void main() { imageStore(image, ivec2(0), vec4(value)); }\n";
    task t = {.order.stage = SHADER_COMPUTE};
    glsl_run(source, SHADER_COMPUTE, answer_and_leave, &t);
}
