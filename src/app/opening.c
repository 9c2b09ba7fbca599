#include "app/opening.h"
#include "app/starts.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TEXT = 1 << 20 };

void opening_free(opening *o) {
    roil_free_recipe(o->recipe);
    *o = (opening){.recipe = NULL};
}

// ---- new files ----------------------------------------------------------------------------------

static bool write_new(roil *r, const char *from, const char *name, opening *out) {
    char file[PATH_CAP];
    size_t copied;
    if (!str_is_identifier(name))
        return err_set("'%s' is no name for an effect: letters, digits and _", name);
    snprintf(out->file, sizeof out->file, "%s.lua", name);
    if (file_exists(out->file)) return err_set("there is a %s already", out->file);
    return starts_find(roil_home(r), from, file) && starts_write(r, file, ".", name, &copied);
}

bool opening_new(roil *r, const char *from, const char *name, opening *out) {
    *out = (opening){.recipe = NULL};
    bool done = write_new(r, from, name, out);
    if (!done) opening_free(out);
    return done;
}

// ---- pictures -----------------------------------------------------------------------------------

static bool open_picture(const char *path, opening *out) {
    out->recipe = roil_read_recipe(path);
    if (!out->recipe) return false;
    if (!out->recipe->effect)
        return err_set("%s was made by an effect outside of the current folder; open that effect, "
                       "or start roil in its folder",
                       path_name(path));
    str_copy(out->file, sizeof out->file, out->recipe->effect);
    return file_exists(out->file) ||
           err_set("%s was made by %s, which is not there", path_name(path), out->file);
}

// ---- volumes ------------------------------------------------------------------------------------

typedef struct volume {
    char folder[PATH_CAP], files[256], name[256], grid[64]; // files: a pattern, in the folder
    size_t frames;
} volume;

// "smoke_0030.vdb" is one of "smoke_*.vdb"; a file without a number stands alone.
static bool find_files(const char *path, volume *v) {
    const char *file = path_name(path), *end = file + strlen(file) - strlen(".vdb"), *digits = end;
    while (digits > file && isdigit((unsigned char)digits[-1])) digits--;
    if (strpbrk(file, "\"\\*?[]\n\r"))
        return err_set("'%s' has letters that an effect cannot name; rename it", file);
    path_folder(v->folder, path);
    snprintf(v->files, sizeof v->files, digits < end ? "%.*s*.vdb" : "%.*s.vdb",
             (int)(digits - file), file);
    const char *stem_end = digits;
    while (stem_end > file && strchr("_-. ", stem_end[-1])) stem_end--;
    snprintf(v->name, sizeof v->name, "%.*s", (int)(stem_end - file), file);
    char real[PATH_CAP];
    if (!v->name[0] && realpath(v->folder, real))
        snprintf(v->name, sizeof v->name, "%.250s", path_name(real));
    for (char *at = v->name; *at; at++)
        if (!isalnum((unsigned char)*at) && *at != '-') *at = '_';
    char pattern[PATH_CAP];
    file_list all;
    if (!path_join(pattern, v->folder, v->files) || !file_glob(pattern, &all)) return false;
    v->frames = all.count;
    file_list_free(&all);
    return v->frames > 0 || err_set("%s: there is no such file", path);
}

// The grid called density, or else the first that is no vector: lines that begin with a name.
static bool find_grid(const char *path, volume *v) {
    char *text = roil_info_vdb(path);
    if (!text) return false;
    for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n') {
        size_t length = strcspn(line, ":\n");
        bool scalar = isgraph((unsigned char)*line) && line[length] == ':' &&
                      strncmp(line + length, ": vec", 5) != 0;
        if (!scalar || length >= sizeof v->grid || memchr(line, '"', length)) continue;
        bool density = length == 7 && strncmp(line, "density", 7) == 0;
        if (!v->grid[0] || density) snprintf(v->grid, sizeof v->grid, "%.*s", (int)length, line);
    }
    roil_free(text);
    return v->grid[0] || err_set("%s has no grid that can be shown", path_name(path));
}

static char *fill_in(const char *text, const volume *v) {
    char frames[24];
    snprintf(frames, sizeof frames, "%zu", v->frames);
    const char *const words[][2] = {
        {"@FILES@", v->files}, {"@NAME@", v->name}, {"@FRAMES@", frames}, {"@GRID@", v->grid}};
    strbuf out = {0};
    while (*text) {
        size_t i = 0;
        while (i < COUNT_OF(words) && strncmp(text, words[i][0], strlen(words[i][0])) != 0) i++;
        if (i < COUNT_OF(words))
            strbuf_add(&out, "%s", words[i][1]);
        else
            strbuf_append(&out, text, 1);
        text += i < COUNT_OF(words) ? strlen(words[i][0]) : 1;
    }
    return out.text;
}

// Whether an effect that is there shows these files already.
static bool shows(const char *effect, const volume *v) {
    void *text;
    size_t size;
    char said[300];
    if (!file_read(effect, MOST_TEXT, &text, &size)) return false;
    snprintf(said, sizeof said, "vdb { \"%s\"", v->files);
    bool found = strstr(text, said) != NULL;
    mem_free(text);
    return found;
}

static char *read_start(const char *home) {
    char path[PATH_CAP];
    void *text;
    size_t size;
    if (!path_join(path, home, "scripts/start/vdb.lua") ||
        !file_read(path, MOST_TEXT, &text, &size))
        return NULL;
    return text;
}

static bool open_volume(const char *home, const char *path, opening *out) {
    volume v = {.frames = 0};
    if (!file_exists(path)) return err_set("%s: there is no such file", path);
    if (!find_files(path, &v) || !find_grid(path, &v)) return false;
    for (int number = 1;; number++) {
        char file[300];
        snprintf(file, sizeof file, number > 1 ? "%s-%d.lua" : "%s.lua", v.name, number);
        if (!path_join(out->file, v.folder, file)) return false;
        if (!file_exists(out->file)) break;
        if (shows(out->file, &v)) return true;
    }
    char *start = read_start(home), *text = start ? fill_in(start, &v) : NULL;
    bool done = text && file_write(out->file, text, strlen(text));
    mem_free(start);
    mem_free(text);
    return done;
}

// ---- whatever it is -----------------------------------------------------------------------------

bool opening_find(const char *home, const char *path, opening *out) {
    *out = (opening){.recipe = NULL};
    bool done;
    if (str_ends_with(path, ".png"))
        done = file_exists(path) ? open_picture(path, out)
                                 : err_set("%s: there is no such file", path);
    else if (str_ends_with(path, ".vdb"))
        done = open_volume(home, path, out);
    else
        done = app_check_effect(path) && str_copy(out->file, sizeof out->file, path);
    if (!done) opening_free(out);
    return done;
}
