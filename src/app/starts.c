#include "app/starts.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include <stdio.h>
#include <string.h>

enum { FILE_MAX = 1 << 30 };

const starts_template starts[STARTS] = {
    {"burst", "A burst of noise, quick to draw", "scripts/start/burst.lua"},
    {"smoke", "Simulated smoke", "scripts/start/smoke.lua"},
    {"fire", "Gas that burns", "scripts/start/fire.lua"},
    {"campfire", "A campfire, with its logs", "effects/pyro_campfire.lua"},
};

// ---- where it comes from ----------------------------------------------------------------------

// Returns whether `name` ends with "_WANTED": campfire stands for pyro_campfire.
static bool ends_with_word(const char *name, const char *wanted) {
    size_t length = strlen(name), end = strlen(wanted);
    return length > end && name[length - end - 1] == '_' &&
           strcmp(name + length - end, wanted) == 0;
}

// Finds an effect that comes with the program by its name, or by the end of it.
static bool find_shipped(const char *home, const char *wanted, char out[PATH_CAP]) {
    char pattern[PATH_CAP];
    file_list files = {0};
    if (!path_join(pattern, home, "effects/*.lua") || !file_glob(pattern, &files)) return false;
    char **names = mem_alloc(files.count * sizeof *names);
    const char *found = NULL;
    bool whole = false;
    for (size_t i = 0; i < files.count; i++) {
        const char *name = path_name(files.paths[i]);
        names[i] = mem_copy(name, strlen(name) + 1);
        names[i][strlen(name) - strlen(".lua")] = '\0';
        bool same = strcmp(names[i], wanted) == 0;
        if (same || (!whole && ends_with_word(names[i], wanted))) found = files.paths[i];
        whole |= same;
    }
    bool done = found && str_copy(out, PATH_CAP, found);
    if (!found)
        words_refuse((const char *const *)names, files.count, wanted,
                     "`roil info effects` lists them", "no effect '%s' comes with roil", wanted);
    for (size_t i = 0; i < files.count; i++) mem_free(names[i]);
    mem_free(names);
    file_list_free(&files);
    return done;
}

bool starts_find(const char *home, const char *wanted, char out[PATH_CAP]) {
    for (size_t i = 0; i < STARTS; i++)
        if (strcmp(starts[i].name, wanted) == 0) return path_join(out, home, starts[i].file);
    return find_shipped(home, wanted, out);
}

// ---- what is written --------------------------------------------------------------------------

bool starts_write_into(const char *folder, const char *name, const void *data, size_t size) {
    char path[PATH_CAP];
    return path_join(path, folder, name) && file_make_parent_folders(path) &&
           file_write(path, data, size);
}

// Copies a file that the effect reads, unless it is there already. Presets go with the effect's new
// name.
static bool copy_into(const char *folder, const roil_input *from, const char *old,
                      const char *effect) {
    static const char presets[] = ".presets/";
    char name[PATH_CAP], there[PATH_CAP];
    void *data, *other = NULL;
    size_t size, held, stem = strlen(old) - strlen(".lua");
    bool preset = strncmp(from->name, old, stem) == 0 &&
                  strncmp(from->name + stem, presets, sizeof presets - 1) == 0;
    snprintf(name, sizeof name, "%s%s", preset ? effect : "", from->name + (preset ? stem : 0));
    if (!path_join(there, folder, name)) return false;
    if (!file_read(from->path, FILE_MAX, &data, &size)) return false;
    bool done = !file_exists(there)
                    ? starts_write_into(folder, name, data, size)
                    : file_read(there, FILE_MAX, &other, &held) &&
                          ((held == size && memcmp(data, other, size) == 0) ||
                           err_set("there is another %s already, which it would read", name));
    mem_free(data);
    mem_free(other);
    return done;
}

// Writes the effect with the commands in its comments as they are in its new place.
static bool write_effect(const roil_input *from, const char *folder, const char *name) {
    void *source;
    size_t size;
    if (!file_read(from->path, FILE_MAX, &source, &size)) return false;
    strbuf out = {0}, old = {0}, path = {0};
    strbuf_add(&old, "effects/%s", from->name); // as in effects/pyro_campfire.lua
    strbuf_add(&path, "%s.lua", name);
    const char *at = source;
    for (const char *next; (next = strstr(at, old.text)); at = next + old.length) {
        strbuf_append(&out, at, (size_t)(next - at));
        strbuf_append(&out, path.text, path.length);
    }
    strbuf_append(&out, at, strlen(at));
    bool done = starts_write_into(folder, path.text, out.text, out.length);
    strbuf_free(&out);
    strbuf_free(&old);
    strbuf_free(&path);
    mem_free(source);
    return done;
}

bool starts_write(roil *r, const char *file, const char *folder, const char *name, size_t *copied) {
    roil_inputs *in = roil_collect(r, file);
    bool done = in != NULL;
    const roil_input *own = NULL;
    *copied = 0;
    for (size_t i = 0; done && i < in->count; i++) {
        const roil_input *one = &in->files[i];
        if (strcmp(one->name, in->effect) == 0) {
            own = one;
            continue;
        }
        done = copy_into(folder, one, in->effect, name);
        *copied += done;
    }
    done = done && own && write_effect(own, folder, name);
    roil_free_inputs(in);
    return done;
}
