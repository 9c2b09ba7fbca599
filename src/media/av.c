#include "media/av.h"
#include "base/error.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

// Loads the versions whose headers this file was compiled with, since other versions have
// structures of another layout.
#define SONAME(library, major) "lib" library ".so." AV_STRINGIFY(major)

typedef struct av_library {
    const char *name;
    void *handle;
} av_library;

typedef struct av_libraries {
    av_library format, codec, util, scale;
} av_libraries;

static av_libraries libraries = {
    .format = {SONAME("avformat", LIBAVFORMAT_VERSION_MAJOR), NULL},
    .codec = {SONAME("avcodec", LIBAVCODEC_VERSION_MAJOR), NULL},
    .util = {SONAME("avutil", LIBAVUTIL_VERSION_MAJOR), NULL},
    .scale = {SONAME("swscale", LIBSWSCALE_VERSION_MAJOR), NULL},
};
av_functions av;
static char problem[512]; // "" when all was found

// `target` is a pointer to a function pointer, which C cannot assign from a void pointer.
static void find_symbol(av_library *library, const char *name, void *target, size_t size) {
    if (problem[0]) return;
    if (!library->handle) library->handle = dlopen(library->name, RTLD_NOW | RTLD_LOCAL);
    void *found = library->handle ? dlsym(library->handle, name) : NULL;
    if (found)
        memcpy(target, &found, size);
    else
        snprintf(problem, sizeof problem, "%s", dlerror());
}

static void load_libraries(void) {
#define FIND(library, name) find_symbol(&libraries.library, #name, &av.name, sizeof av.name);
    AV_FUNCTIONS(FIND)
}

bool av_load(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load_libraries);
    return !problem[0] || err_set("videos need FFmpeg's libraries: %s", problem);
}
