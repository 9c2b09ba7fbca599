#include "media/optical_flow.h"
#include "base/error.h"
#include "base/file.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static optical_flow_function *found;
static char problem[512]; // "" when it was found

static void load(void) {
    char program[PATH_CAP], folder[PATH_CAP], path[PATH_CAP];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    path_folder(folder, program);
    void *library =
        path_join(path, folder, "libroil-flow.so") ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
    void *symbol = library ? dlsym(library, OPTICAL_FLOW_FUNCTION) : NULL;
    if (symbol)
        memcpy(&found, &symbol, sizeof found);
    else
        snprintf(problem, sizeof problem, "%s", dlerror());
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
