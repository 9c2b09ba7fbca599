// glslang where it can do no harm: in a worker of the reader (base/isolate.h). GLSL comes from
// strangers, and twenty lines of it, macros that double each other, keep glslang busy for years or
// eat all memory; others crash it. Reflecting the code is the caller's work, but the worker has
// done just that before: what ended there ends there.
#pragma once
#include "base/isolate.h"
#include "shader/unit.h"

typedef struct compiler_order {
    shader_stage stage;
    bool strange; // a stranger wrote a part of it: the code is validated, too (unit.h)
} compiler_order;

// False with "the compiler ran out of time (10 s)" and the like, without a position; true when the
// compiler gave an answer, which may be a refusal. Free the answer's data with mem_free. Any
// thread may call this.
bool compiler_run(const char *source, const compiler_order *order, glsl_answer *out);

// Of one compile: processor time, and memory beyond the reader's. Tests set less.
enum { COMPILER_MILLISECONDS = 10000, COMPILER_MEGABYTES = 1024 };
void compiler_set_limits(uint32_t milliseconds, uint32_t megabytes);

// ---- in the reader ----------------------------------------------------------------------------

bool compiler_work(const isolate_call *call);
void compiler_get_ready(void); // glslang's tables, made once for all workers
