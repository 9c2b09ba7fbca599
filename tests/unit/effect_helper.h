// An effect without a device in a folder of its own, for one test: written, used, removed.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "effect/effect.h"
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct stage {
    char folder[64];
    effect *e;
} stage;

#define ok(result)                                                                                 \
    do {                                                                                           \
        if (!(result)) fail_msg("%s: %s", #result, err_get());                                     \
    } while (0)

static inline void assert_error(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("\"%s\" is not in: %s", part, err_get());
}

static inline void write_file(const stage *s, const char *name, const char *text) {
    char path[PATH_CAP];
    assert_true(path_join(path, s->folder, name));
    ok(file_write(path, text, strlen(text)));
}

// Opens the effect anew, with these settings.
static inline void open_with(stage *s, const effect_setting *settings, size_t count) {
    char file[PATH_CAP], shaders[PATH_CAP];
    const char *root = getenv("ROIL_SOURCE_DIR");
    assert_true(path_join(file, s->folder, "test.lua"));
    assert_true(path_join(shaders, root ? root : "..", "shaders"));
    effect_destroy(s->e);
    s->e = effect_create(&(effect_desc){
        .file = file, .shader_root = shaders, .settings = settings, .setting_count = count});
    ok(s->e);
}

static inline int open_stage(void **state) {
    stage *s = mem_alloc(sizeof *s);
    strcpy(s->folder, "/tmp/roil-effect-XXXXXX");
    assert_non_null(mkdtemp(s->folder));
    open_with(s, NULL, 0);
    *state = s;
    return 0;
}

static inline int remove_entry(const char *path, const struct stat *info, int kind,
                               struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

static inline int close_stage(void **state) {
    stage *s = *state;
    effect_destroy(s->e);
    nftw(s->folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    mem_free(s);
    return 0;
}

static inline const field *number(stage *s, float value) {
    return field_constant(effect_memory(s->e), 1, (float[4]){value});
}

static inline const field *ball(stage *s) {
    const field *made =
        field_make(effect_memory(s->e), "sphere", (const field *[FIELD_MAX_ARGS]){0}, NULL);
    ok(made);
    return made;
}

static inline pass *add_march(stage *s, const char *label) {
    pass *p = effect_add_pass(s->e, "march", NULL, label);
    ok(p && pass_set_field(p, "density", ball(s)));
    return p;
}

static inline float uniform_of(const pass *p, const char *name, int component) {
    size_t index;
    float value[4];
    assert_int_equal(pass_find_key(p, name, &index), PASS_UNIFORM);
    assert_non_null(pass_get_uniform(p, index));
    ok(field_eval(pass_get_uniform(p, index), &(field_context){0}, (float3){0, 0, 0}, value));
    return value[component];
}

#define STAGE_TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, close_stage)
