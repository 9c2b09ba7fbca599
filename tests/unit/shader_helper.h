// A folder of shaders for one test: written, used, removed.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/file.h"
#include "shader/shader.h"
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct place {
    char top[64];
    char program[80], effect[80], cache[80]; // folders inside `top`
    shader_library *library;
    arena memory;
} place;

static inline void place_open(place *p) {
    p->library = shader_library_create(&(shader_library_desc){
        .shader_root = p->program, .effect_root = p->effect, .cache_dir = p->cache});
    assert_non_null(p->library);
}

static inline int place_setup(void **state) {
    place *p = calloc(1, sizeof *p);
    strcpy(p->top, "/tmp/roil-shader-XXXXXX");
    assert_non_null(mkdtemp(p->top));
    snprintf(p->program, sizeof p->program, "%s/program", p->top);
    snprintf(p->effect, sizeof p->effect, "%s/effect", p->top);
    snprintf(p->cache, sizeof p->cache, "%s/cache", p->top);
    assert_true(file_make_folders(p->program));
    assert_true(file_make_folders(p->effect));
    place_open(p);
    *state = p;
    return 0;
}

static inline int place_remove(const char *path, const struct stat *info, int kind,
                               struct FTW *walk) {
    (void)info;
    (void)kind;
    (void)walk;
    return remove(path);
}

static inline int place_teardown(void **state) {
    place *p = *state;
    shader_library_destroy(p->library);
    arena_free(&p->memory);
    nftw(p->top, place_remove, 16, FTW_DEPTH | FTW_PHYS);
    free(p);
    return 0;
}

// Writes TOP/name, for example "effect/a.comp".
static inline void place_write(place *p, const char *name, const char *text) {
    char path[PATH_CAP];
    assert_true(path_join(path, p->top, name));
    assert_true(file_make_parent_folders(path));
    assert_true(file_write(path, text, strlen(text)));
}

static inline void place_compile(place *p, const shader_compile_desc *desc, shader_binary *out) {
    if (!shader_compile(p->library, &p->memory, desc, out)) fail_msg("%s", err_get());
}

static inline void assert_error(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("\"%s\" is not in: %s", part, err_get());
}

// Compiling must fail, with a message that holds `part`.
static inline void place_refuses(place *p, const char *name, const char *part) {
    shader_binary binary;
    err_clear();
    assert_false(
        shader_compile(p->library, &p->memory, &(shader_compile_desc){.name = name}, &binary));
    assert_error(part);
}

static inline const shader_slot *find_slot(const shader_binary *binary, const char *name) {
    for (size_t i = 0; i < binary->slot_count; i++)
        if (strcmp(binary->slots[i].name, name) == 0) return &binary->slots[i];
    return NULL;
}

static inline const shader_member *find_member(const shader_binary *binary, const char *name) {
    for (size_t i = 0; i < binary->member_count; i++)
        if (strcmp(binary->members[i].name, name) == 0) return &binary->members[i];
    return NULL;
}

#define PLACE_TEST(name) cmocka_unit_test_setup_teardown(name, place_setup, place_teardown)
