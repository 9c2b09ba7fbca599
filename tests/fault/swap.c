// Preloaded: once ROIL_SWAP_SEEN has been looked at for the ROIL_SWAP_AT-th time, by realpath or by
// an opening below a folder, a link to ROIL_SWAP_TARGET stands where the file or folder
// ROIL_SWAP_THING was. What is opened after that is not what was looked at.
#include <dlfcn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static void swap(const char *thing, const char *target) {
    char aside[4096];
    snprintf(aside, sizeof aside, "%s.aside", thing);
    if (rename(thing, aside) != 0 || symlink(target, thing) != 0) abort();
}

static void look(const char *found) {
    static _Atomic long looks;
    const char *at = getenv("ROIL_SWAP_AT"), *seen = getenv("ROIL_SWAP_SEEN");
    if (at && seen && strcmp(found, seen) == 0 && ++looks == strtol(at, NULL, 10))
        swap(getenv("ROIL_SWAP_THING"), getenv("ROIL_SWAP_TARGET"));
}

char *realpath(const char *restrict path, char *restrict resolved) {
    static char *(*_Atomic real)(const char *, char *);
    if (!real) real = (char *(*)(const char *, char *))dlvsym(RTLD_NEXT, "realpath", "GLIBC_2.3");
    if (!real) real = (char *(*)(const char *, char *))dlsym(RTLD_NEXT, "realpath");
    char *found = real(path, resolved);
    if (found) look(found);
    return found;
}

static void look_at(long file) {
    char link[64], found[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%ld", file);
    ssize_t length = readlink(link, found, sizeof found - 1);
    if (length <= 0) return;
    found[length] = '\0';
    look(found);
}

long syscall(long number, ...) {
    static long (*_Atomic real)(long, ...);
    long a[6];
    va_list all;
    va_start(all, number);
    for (int i = 0; i < 6; i++) a[i] = va_arg(all, long);
    va_end(all);
    if (!real) real = (long (*)(long, ...))dlsym(RTLD_NEXT, "syscall");
    long result = real(number, a[0], a[1], a[2], a[3], a[4], a[5]);
    if (number == SYS_openat2 && result >= 0) look_at(result);
    return result;
}

int openat(int folder, const char *path, int flags, ...) {
    static int (*_Atomic real)(int, const char *, int, ...);
    va_list mode;
    va_start(mode, flags);
    if (!real) real = (int (*)(int, const char *, int, ...))dlsym(RTLD_NEXT, "openat");
    int result = real(folder, path, flags, va_arg(mode, unsigned));
    va_end(mode);
    if (result >= 0) look_at(result);
    return result;
}
