// roil new NAME: a folder with an effect that draws, all that it reads, and what editors need.
#include "app/app.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include <ctype.h>
#include <dirent.h>
#include <popt.h>
#include <stdlib.h>
#include <string.h>

enum { FILE_MAX = 1 << 30 };

static const char settings_of_editors[] = "{\n"
                                          "  \"runtime.version\": \"Lua 5.4\",\n"
                                          "  \"workspace.library\": [\".roil\"],\n"
                                          "  \"diagnostics.libraryFiles\": \"Disable\"\n"
                                          "}\n";

// Returns the last part of a path, which becomes the name of the effect's file; NULL with a message
// if it cannot be one.
static const char *name_of(const char *folder) {
    const char *name = path_name(folder);
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '_' && *c != '-') name = "";
    if (name[0] && name[0] != '-') return name;
    err_set("'%s' cannot be an effect; a name has letters, digits, _ and -", folder);
    return NULL;
}

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
    const char *near = str_nearest(wanted, (const char *const *)names, files.count);
    if (!found && near)
        err_set("no effect '%s' comes with roil; did you mean '%s'?", wanted, near);
    else if (!found)
        err_set("no effect '%s' comes with roil; `roil info effects` lists them", wanted);
    for (size_t i = 0; i < files.count; i++) mem_free(names[i]);
    mem_free(names);
    file_list_free(&files);
    return done;
}

// ---- what is written --------------------------------------------------------------------------

static bool write_into(const char *folder, const char *name, const void *data, size_t size) {
    char path[PATH_CAP];
    return path_join(path, folder, name) && file_make_parent_folders(path) &&
           file_write(path, data, size);
}

static bool copy_into(const char *folder, const char *from, const char *name) {
    char path[PATH_CAP];
    void *data;
    size_t size;
    if (!path_join(path, from, name) || !file_read(path, FILE_MAX, &data, &size)) return false;
    bool done = write_into(folder, name, data, size);
    mem_free(data);
    return done;
}

// Writes the effect with the commands in its comments as they are in its new place.
static bool write_effect(const char *file, const char *folder, const char *name) {
    void *source;
    size_t size;
    if (!file_read(file, FILE_MAX, &source, &size)) return false;
    strbuf out = {0}, old = {0}, path = {0};
    strbuf_add(&old, "effects/%s", path_name(file));
    strbuf_add(&path, "%s.lua", name);
    const char *at = source;
    for (const char *next; (next = strstr(at, old.text)); at = next + old.length) {
        strbuf_append(&out, at, (size_t)(next - at));
        strbuf_append(&out, path.text, path.length);
    }
    strbuf_append(&out, at, strlen(at));
    bool done = write_into(folder, path.text, out.text, out.length);
    strbuf_free(&out);
    strbuf_free(&old);
    strbuf_free(&path);
    mem_free(source);
    return done;
}

static bool is_free(const char *folder) {
    DIR *open = opendir(folder);
    size_t count = 0;
    while (open && readdir(open)) count++;
    if (open) closedir(open);
    if (count > 2)
        return err_set("%s: there is something in it already; name a new folder", folder);
    return open || !file_exists(folder) || err_set("%s: a file of that name is there", folder);
}

static bool make_all(roil *r, const char *file, const char *folder, const char *name) {
    char from[PATH_CAP];
    app_files files = {0};
    path_folder(from, file);
    bool done = app_collect_files(r, file, &files);
    size_t copied = 0;
    for (size_t i = 0; done && i < files.count; i++) {
        if (strcmp(files.paths[i], path_name(file)) == 0) continue;
        done = copy_into(folder, from, files.paths[i]);
        copied += done;
    }
    app_free_files(&files);
    char *words = done ? roil_info_lua_meta(r) : NULL;
    done = words && write_into(folder, ".roil/words.lua", words, strlen(words)) &&
           write_into(folder, ".luarc.json", settings_of_editors, strlen(settings_of_editors)) &&
           write_effect(file, folder, name);
    roil_free(words);
    if (done)
        app_print(stdout,
                  "made %s/%s.lua, with %zu file%s that it reads, and .luarc.json for editors\n"
                  "Begin with `roil live %s/%s.lua`.\n",
                  folder, name, copied, copied == 1 ? "" : "s", folder, name);
    return done;
}

static int make(char *folder, const char *from) {
    while (strlen(folder) > 1 && str_ends_with(folder, "/")) folder[strlen(folder) - 1] = '\0';
    const char *name = name_of(folder);
    if (!name || !is_free(folder)) return app_fail_input();
    char file[PATH_CAP];
    roil *r = roil_create(&(roil_desc){.no_device = true});
    bool own = str_ends_with(from, ".lua");
    bool found = r && (own ? app_check_effect(from) && str_copy(file, sizeof file, from)
                           : find_shipped(roil_home(r), from, file));
    int status = found && make_all(r, file, folder, name) ? APP_DONE : app_fail_input();
    roil_destroy(r);
    return status;
}

int cmd_new(int argc, const char **argv) {
    const char *from = "campfire";
    const struct poptOption options[] = {
        {"from", '\0', POPT_ARG_STRING, &from, 0,
         "which effect it begins as: campfire, burst, smoke, or another of `roil info effects` "
         "(default: campfire)",
         "EFFECT|FILE.lua"},
        POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = poptGetContext("roil new", argc, argv, options, 0);
    poptSetOtherOptionHelp(context, "NAME [--from EFFECT]");
    int code = poptGetNextOpt(context), status;
    const char *name = poptGetArg(context), *more = poptGetArg(context);
    if (code < -1) {
        app_refuse_option(context, options, code);
        status = app_fail(APP_BAD_USAGE, "new: %s", roil_error());
    } else if (!name || more) {
        status = app_fail(APP_BAD_USAGE, "new: one name is needed, as in `roil new my-fire`");
    } else {
        char *folder = mem_copy(name, strlen(name) + 1);
        status = make(folder, from);
        mem_free(folder);
    }
    poptFreeContext(context);
    return status;
}
