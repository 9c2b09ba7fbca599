#include "shader/compiler.h"
#include "base/memory.h"
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

typedef struct answer_head { // then `size` bytes
    glsl_outcome outcome;
    size_t size;
} answer_head;

static atomic_uint limit_ms = COMPILER_MILLISECONDS, limit_mb = COMPILER_MEGABYTES;

void compiler_set_limits(uint32_t milliseconds, uint32_t megabytes) {
    atomic_store(&limit_ms, milliseconds);
    atomic_store(&limit_mb, megabytes);
}

static bool take_answer(const isolate_result *r, glsl_answer *out) {
    answer_head head = {0};
    if (r->size >= sizeof head) memcpy(&head, r->data, sizeof head);
    bool valid = r->size >= sizeof head && head.size == r->size - sizeof head &&
                 head.outcome <= GLSL_LAST &&
                 (head.outcome != GLSL_DONE || head.size % sizeof(uint32_t) == 0);
    if (!valid) return err_set("the compiler left no answer");
    char *copy = mem_alloc(head.size + 1); // a log ends with the zero
    memcpy(copy, (const char *)r->data + sizeof head, head.size);
    *out = (glsl_answer){.outcome = head.outcome, .data = copy, .size = head.size};
    return true;
}

bool compiler_run(const char *source, const compiler_order *order, glsl_answer *out) {
    isolate_result result;
    const isolate_job job = {.kind = "glsl",
                             .who = "the compiler",
                             .arguments = order,
                             .argument_size = sizeof *order,
                             .bytes = source,
                             .size = strlen(source),
                             .limits = {.processor_ms = atomic_load(&limit_ms),
                                        .memory = (uint64_t)atomic_load(&limit_mb) << 20,
                                        .result = 2 * (uint64_t)SPIRV_MAX_SIZE}};
    if (!isolate_run(&job, &result)) return false;
    bool done = take_answer(&result, out);
    isolate_free(&result);
    return done;
}

// ---- in the reader ----------------------------------------------------------------------------

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
    const answer_head head = {.outcome = answer->outcome, .size = answer->size};
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
