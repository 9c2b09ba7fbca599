// Preloaded: once realpath has found ROIL_SWAP_SEEN for the ROIL_SWAP_AT-th time, a link to
// ROIL_SWAP_TARGET stands where the file or folder ROIL_SWAP_THING was. What is opened after that
// is not what was looked at.
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void swap(const char *thing, const char *target) {
    char aside[4096];
    strncpy(aside, thing, sizeof aside - 8);
    aside[sizeof aside - 8] = '\0';
    strcat(aside, ".aside");
    if (rename(thing, aside) != 0 || symlink(target, thing) != 0) abort();
}

char *realpath(const char *restrict path, char *restrict resolved) {
    static _Atomic long seen;
    static char *(*real)(const char *, char *);
    if (!real) real = (char *(*)(const char *, char *))dlvsym(RTLD_NEXT, "realpath", "GLIBC_2.3");
    if (!real) real = (char *(*)(const char *, char *))dlsym(RTLD_NEXT, "realpath");
    char *found = real(path, resolved);
    const char *at = getenv("ROIL_SWAP_AT"), *wanted = getenv("ROIL_SWAP_SEEN");
    if (found && at && wanted && strcmp(found, wanted) == 0 && ++seen == strtol(at, NULL, 10))
        swap(getenv("ROIL_SWAP_THING"), getenv("ROIL_SWAP_TARGET"));
    return found;
}
