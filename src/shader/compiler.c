// The client: asks the reader. What works there is in compiler_work.c, so that a program that only
// asks carries no compiler.
#include "shader/compiler.h"
#include "base/memory.h"
#include <glslang/build_info.h>
#include <stdatomic.h>
#include <string.h>

static atomic_uint limit_ms = COMPILER_MILLISECONDS, limit_mb = COMPILER_MEGABYTES;

uint32_t glsl_version(void) {
    return GLSLANG_VERSION_MAJOR * 10000 + GLSLANG_VERSION_MINOR * 100 + GLSLANG_VERSION_PATCH;
}

void compiler_set_limits(uint32_t milliseconds, uint32_t megabytes) {
    atomic_store(&limit_ms, milliseconds);
    atomic_store(&limit_mb, megabytes);
}

static bool take_answer(const isolate_result *r, glsl_answer *out) {
    compiler_answer head = {0};
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
