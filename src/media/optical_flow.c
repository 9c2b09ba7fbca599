#include "media/optical_flow.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static optical_flow_function *found;
static char problem[512]; // "" when it was found

static void load(void) {
    static const char *const places[] = {"libroil-flow.so", "../libexec/roil/libroil-flow.so",
                                         "../../libexec/roil/libroil-flow.so"};
    char folder[PATH_CAP], path[PATH_CAP];
    void *library = NULL;
    for (size_t i = 0; path_own_folder(folder) && !library && i < COUNT_OF(places); i++)
        if (path_join(path, folder, places[i])) library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *symbol = library ? dlsym(library, OPTICAL_FLOW_FUNCTION) : NULL;
    const char *why = symbol ? NULL : dlerror();
    if (symbol)
        memcpy(&found, &symbol, sizeof found);
    else
        snprintf(problem, sizeof problem, "%s", why ? why : "libroil-flow.so is not there");
}

bool optical_flow_load(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    return found ||
           err_set(
               "motion is estimated from pictures by OpenCV (apt-get install libopencv-video-dev, "
               "then build roil again): %s",
               problem);
}

bool optical_flow_find(const uint8_t *from, const uint8_t *to, uint32_t width, uint32_t height,
                       float *out) {
    return found(from, to, (int)width, (int)height, out) || err_set("OpenCV finds no motion");
}
