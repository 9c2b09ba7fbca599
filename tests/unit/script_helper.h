// Effects from text, without a device.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/isolate.h"
#include "base/log.h"
#include "effect/events.h"
#include "script/script.h"

static char helper_folder[PATH_CAP];

static inline void helper_source(char out[PATH_CAP], const char *name) {
    const char *root = getenv("ROIL_SOURCE_DIR");
    assert_true(path_join(out, root ? root : "..", name));
}

// Writes a file beside the effect.
static inline void helper_put(const char *name, const char *text) {
    char path[PATH_CAP];
    assert_true(path_join(path, helper_folder, name));
    assert_true(file_make_parent_folders(path));
    assert_true(file_write(path, text, strlen(text)));
}

static inline effect *helper_create(const char *file, const effect_setting *settings,
                                    size_t count) {
    char shaders[PATH_CAP];
    helper_source(shaders, "shaders");
    effect *e = effect_create(&(effect_desc){
        .file = file, .shader_root = shaders, .settings = settings, .setting_count = count});
    if (!e) fail_msg("%s", err_get());
    return e;
}

// Loads `text` as an effect. NULL with a message.
static inline effect *helper_load_with(const char *text, const script_limits *limits,
                                       const effect_setting *settings, size_t count) {
    char scripts[PATH_CAP], path[PATH_CAP];
    helper_source(scripts, "scripts");
    helper_put("e.lua", text);
    assert_true(path_join(path, helper_folder, "e.lua"));
    effect *e = helper_create(path, settings, count);
    err_clear();
    if (script_load_limited(e, scripts, limits)) return e;
    assert_string_not_equal(err_get(), "");
    effect_destroy(e);
    return NULL;
}

static inline effect *helper_load(const char *text) {
    return helper_load_with(text, NULL, NULL, 0);
}

// A script with something before and after it, which is refused with a message.
static inline void helper_refuses(const char *head, const char *text, const char *tail,
                                  const char *message) {
    char whole[2048];
    snprintf(whole, sizeof whole, "%s%s%s", head, text, tail);
    if (helper_load(whole)) fail_msg("no error in: %s", text);
    if (!strstr(err_get(), message)) fail_msg("in: %s\n got: %s", text, err_get());
}

// One that is not.
static inline effect *helper_accepts(const char *head, const char *text, const char *tail,
                                     const effect_setting *settings, size_t count) {
    char whole[2048];
    snprintf(whole, sizeof whole, "%s%s%s", head, text, tail);
    effect *e = helper_load_with(whole, NULL, settings, count);
    if (!e) fail_msg("%s", err_get());
    return e;
}

static inline void helper_is_set(effect *e, const char *name, const char *value) {
    const effect_control *c = effect_find_control(e, name);
    if (!c) fail_msg("%s", err_get());
    strbuf text = {0};
    effect_print_control(e, c, &text);
    if (strcmp(strbuf_text(&text), value) != 0)
        fail_msg("%s is %s, not %s", name, strbuf_text(&text), value);
    strbuf_free(&text);
}

// Runs the script up to a frame, which is not drawn.
static inline void helper_run(effect *e, double frame) {
    if (!effect_rehearse(e, frame)) fail_msg("frame %g: %s", frame, err_get());
}

static inline double helper_status(const effect *e, const char *name) {
    const effect_status *all;
    size_t count = effect_statuses(e, &all);
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no status '%s'", name);
    return 0;
}

static inline int helper_setup(void **state) {
    (void)state;
    log_set_level(LOG_WARNING);
    isolate_warm_up("glsl"); // as the program does
    const char *temporary = getenv("TMPDIR");
    snprintf(helper_folder, sizeof helper_folder, "%s/roil-script-XXXXXX",
             temporary ? temporary : "/tmp");
    return mkdtemp(helper_folder) ? 0 : 1;
}

static inline int helper_teardown(void **state) {
    (void)state;
    char command[PATH_CAP + 20];
    snprintf(command, sizeof command, "rm -rf '%s'", helper_folder);
    return system(command);
}
