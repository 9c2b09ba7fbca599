// glslang and SPIRV-Cross recurse over expressions and calls of a shader, which a stranger may have
// written. They run on a stack that is large enough for everything that shader/glsl.c lets through.
#include "base/stack.h"
#include "base/error.h"
#include <pthread.h>

static const size_t size = (size_t)256 << 20; // address space; only what is used costs

bool run_on_large_stack(void *(*run)(void *), void *user) {
    pthread_t thread;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    bool started = pthread_attr_setstacksize(&attributes, size) == 0 &&
                   pthread_create(&thread, &attributes, run, user) == 0;
    pthread_attr_destroy(&attributes);
    if (!started)
        return err_set(
            "no thread with a stack of %zu MiB can be made: there is too little memory, or "
            "there are too many processes",
            size >> 20);
    pthread_join(thread, NULL);
    return true;
}
