// Parses the command line: unknown options, frames, sizes and file patterns.
#include "app/app.h"
#include "base/error.h"
#include "base/file.h"
#include "base/frames.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct option_names {
    const char *names[64];
    size_t count;
} option_names;

static void list_options(option_names *list, const struct poptOption *options) {
    for (const struct poptOption *o = options; o->longName || o->shortName || o->arg; o++) {
        if ((o->argInfo & POPT_ARG_MASK) == POPT_ARG_INCLUDE_TABLE) {
            list_options(list, o->arg);
        } else if (o->longName) {
            assert(list->count < COUNT_OF(list->names));
            list->names[list->count++] = o->longName;
        }
    }
}

static bool refuse_option(poptContext context, const struct poptOption *options, int code) {
    const char *given = poptBadOption(context, 0);
    if (code != POPT_ERROR_BADOPT) return err_set("%s: %s", given, poptStrerror(code));
    option_names known = {0};
    list_options(&known, options);
    const char *word = given + strspn(given, "-");
    strbuf text = {0};
    strbuf_append(&text, word, strcspn(word, "="));
    const char *near = str_nearest(strbuf_text(&text), known.names, known.count);
    strbuf_free(&text);
    if (near) return err_set("unknown option '%s'; did you mean '--%s'?", given, near);
    for (size_t i = 0; i < known.count; i++)
        strbuf_add(&text, i ? ", --%s" : "--%s", known.names[i]);
    err_set("unknown option '%s'; accepted: %s", given, strbuf_text(&text));
    strbuf_free(&text);
    return false;
}

static bool take_option(const app_task *t, int option, char *text) {
    switch (option) {
    case APP_SET:
        return app_add_set(t->settings, text);
    case APP_PRESET:
        app_add_preset(t->settings, text);
        return true;
    case APP_EVENT:
        app_add_event(t->settings, text);
        return true;
    case APP_FRAMES:
        app_free_frames(t->frames); // of one before
        return app_parse_frames(text, t->frames);
    }
    return t->take(t->job, option, text);
}

static bool take_all(const app_task *t, poptContext context, const struct poptOption *options) {
    int option;
    while ((option = poptGetNextOpt(context)) > 0)
        if (!take_option(t, option, poptGetOptArg(context))) return false;
    return option < -1 ? refuse_option(context, options, option) : t->check(t->job, context);
}

int app_run(int argc, const char **argv, const char *name, const char *usage,
            const struct poptOption *options, const app_task *t) {
    const char *word = strchr(name, ' ') + 1; // "export" of "roil export vdb"
    poptContext context = app_options(name, argc, argv, options, usage);
    int status = take_all(t, context, options) ? t->run(t->job)
                                               : app_fail(APP_BAD_USAGE, "%.*s: %s",
                                                          (int)strcspn(word, " "), word, err_get());
    poptFreeContext(context);
    if (t->settings) app_free_settings(t->settings);
    if (t->frames) app_free_frames(t->frames);
    return status;
}

bool app_take_effect(poptContext arguments, const char **file, const char *missing) {
    *file = poptGetArg(arguments);
    if (!*file) return err_set("%s", missing);
    const char *more = poptGetArg(arguments);
    return !more || err_set("'%s': one effect at a time", more);
}

// ---- frames and sizes -------------------------------------------------------------------------

bool app_parse_frames(const char *text, app_frames *out) {
    *out = (app_frames){.step = 1};
    if (!frames_parse(text, &out->numbers, &out->count)) return false;
    if (out->count > 1) out->step = out->numbers[1] - out->numbers[0];
    if (!(out->step > 0)) out->step = 1;
    return true;
}

void app_free_frames(app_frames *frames) {
    mem_free(frames->numbers);
    *frames = (app_frames){.step = 1};
}

void app_warn_of_frames(const app_frames *frames, const roil_effect_info *info) {
    double first = info->first_frame, last = first + info->frames - 1;
    for (size_t i = 0; i < frames->count; i++) {
        double frame = frames->numbers[i];
        if (frame >= first && frame <= last) continue;
        log_write(LOG_WARNING, "frame %g is none of the effect's, which are %g to %g", frame, first,
                  last);
        return;
    }
}

void app_warn_of_trouble(const roil_effect *e) {
    roil_simulation s;
    if (roil_get_simulation(e, &s) && s.trouble)
        log_write(LOG_WARNING, "%s: %s", s.pass, s.trouble);
}

bool app_parse_size(const char *text, uint32_t *width, uint32_t *height) {
    char rest;
    if (isdigit((unsigned char)text[0]) && sscanf(text, "%5ux%5u%c", width, height, &rest) == 2 &&
        *width >= 1 && *height >= 1 && *width <= 16384 && *height <= 16384)
        return true;
    return err_set("size '%s'; accepted: WIDTHxHEIGHT, as 960x540, up to 16384", text);
}

bool app_parse_samples(const char *option, const char *text, uint32_t *out) {
    char *end;
    long samples = strtol(text, &end, 10);
    if (end == text || *end || samples < 1 || samples > 65536)
        return err_set("%s '%s'; accepted: 1 to 65536 samples a pixel", option, text);
    *out = (uint32_t)samples;
    return true;
}

bool app_check_shutter(double frames) {
    return (frames >= 0 && frames <= 1) || err_set("--shutter %g; accepted: 0 to 1 frames", frames);
}

// ---- file patterns ----------------------------------------------------------------------------

bool app_has_number(const char *pattern) {
    return strchr(pattern, '%') != NULL;
}

bool app_check_pattern(const char *pattern) {
    const char *mark = strchr(pattern, '%');
    if (!mark) return true;
    const char *at = mark + 1;
    while (isdigit((unsigned char)*at) && at - mark < 4) at++;
    if (*at == 'd' && !strchr(at, '%')) return true;
    return err_set("output '%s'; accepted: one number in it, as out/%%04d.png", pattern);
}

void app_format_pattern(const char *pattern, double frame, char *out, size_t capacity) {
    const char *mark = strchr(pattern, '%');
    if (!mark) {
        str_copy(out, capacity, pattern);
        return;
    }
    bool zeros = mark[1] == '0';
    char *end;
    int width = (int)strtol(mark + 1, &end, 10);
    snprintf(out, capacity, zeros ? "%.*s%0*ld%s" : "%.*s%*ld%s", (int)(mark - pattern), pattern,
             width, lrint(frame), end + 1);
}

bool app_may_write_here(const char *path) {
    char real[PATH_CAP];
    struct stat info;
    if (!path_confine(real, ".", path))
        return err_prefix("the default output (-o names another): ");
    return stat(path, &info) != 0 || S_ISREG(info.st_mode) || S_ISDIR(info.st_mode) ||
           err_set("%s: not a regular file", path);
}

char *app_quoted(arena *memory, const char *text) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=:,./@%";
    const char *before = text[0] == '-' ? "./" : "";
    if (text[0] && !text[strspn(text, plain)]) return arena_format(memory, "%s%s", before, text);
    strbuf out = {0};
    strbuf_add(&out, "'%s", before);
    for (; *text; text++) strbuf_add(&out, *text == '\'' ? "'\\''" : "%c", *text);
    strbuf_add(&out, "'");
    char *kept = arena_string(memory, strbuf_text(&out));
    strbuf_free(&out);
    return kept;
}

bool app_can_write(const char *file) {
    struct stat info;
    file_draft draft;
    if (stat(file, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)) return true;
    if (!file_make_parent_folders(file) || !file_draft_begin(&draft, file)) return false;
    file_draft_drop(&draft);
    return true;
}
