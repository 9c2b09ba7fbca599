// Runs glslang where it can do no harm: in a worker of the reader (base/isolate.h). GLSL comes from
// strangers. Twenty lines of it, macros that double each other, keep glslang busy for years or take
// all memory; others crash it. The caller reflects the code, but the worker has done the same
// before, so that code on which reflection crashes ends the worker only.
#pragma once
#include "base/isolate.h"
#include "shader/unit.h"

typedef struct compiler_order {
    shader_stage stage;
    bool strange; // a stranger wrote a part of it: the code must be validated too (unit.h)
} compiler_order;

typedef struct compiler_answer { // what the reader sends: this, then `size` bytes
    glsl_outcome outcome;
    size_t size;
} compiler_answer;

// Compiles a text. True when the compiler gave an answer, which may be a refusal; free its data
// with mem_free. False with a message without a position, such as "the compiler ran out of time (10
// s)". Any thread.
bool compiler_run(const char *source, const compiler_order *order, glsl_answer *out);

// Limits of one compilation: processor time, and memory beyond the reader's. Tests set less.
enum { COMPILER_MILLISECONDS = 10000, COMPILER_MEGABYTES = 1024 };
void compiler_set_limits(uint32_t milliseconds, uint32_t megabytes);

// ---- the reader -------------------------------------------------------------------------------

bool compiler_work(const isolate_call *call);
void compiler_get_ready(void); // makes glslang's tables once for all workers
