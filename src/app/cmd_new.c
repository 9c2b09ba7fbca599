// roil new NAME: a folder with an effect that draws, all that it reads, and what editors need.
#include "app/device_options.h"
#include "app/starts.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <ctype.h>
#include <dirent.h>
#include <popt.h>
#include <string.h>

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

// ---- what is written --------------------------------------------------------------------------

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
    size_t copied;
    char *words = roil_info_lua_meta(r);
    bool done =
        words && starts_write(r, file, folder, name, &copied) &&
        starts_write_into(folder, ".roil/words.lua", words, strlen(words)) &&
        starts_write_into(folder, ".luarc.json", settings_of_editors, strlen(settings_of_editors));
    roil_free(words);
    if (done)
        app_print(stdout,
                  "made %s/%s.lua, with %zu file%s that it reads, and .luarc.json for editors\n"
                  "Begin with `roil live %s/%s.lua`.\n",
                  folder, name, copied, copied == 1 ? "" : "s", folder, name);
    return done;
}

typedef struct new_job {
    const char *name, *from, **assets;
} new_job;

static int make(void *user) {
    const new_job *j = user;
    const char *from = j->from;
    char *folder = mem_copy(j->name, strlen(j->name) + 1), file[PATH_CAP];
    while (strlen(folder) > 1 && str_ends_with(folder, "/")) folder[strlen(folder) - 1] = '\0';
    const char *name = name_of(folder);
    bool is_good = name && is_free(folder);
    roil *r = is_good ? roil_create(&(roil_desc){.no_device = true, .assets = j->assets}) : NULL;
    bool own = str_ends_with(from, ".lua") || str_ends_with(from, ".roil");
    bool found = r && (own ? app_check_effect(from) && str_copy(file, sizeof file, from)
                           : starts_find(roil_home(r), from, file));
    int status = found && make_all(r, file, folder, name) ? APP_DONE : app_fail_input();
    roil_destroy(r);
    mem_free(folder);
    return status;
}

static bool new_check(void *user, poptContext arguments) {
    new_job *j = user;
    j->name = poptGetArg(arguments);
    return (j->name && !poptPeekArg(arguments)) ||
           err_set("one name is needed, as in `roil new my-fire`");
}

int cmd_new(int argc, const char **argv) {
    new_job j = {.from = "campfire"};
    const struct poptOption options[] = {
        {"from", '\0', POPT_ARG_STRING, &j.from, 0,
         "what it begins as: campfire, fire, smoke, burst, or one of `roil info effects` (default: "
         "campfire)",
         "EFFECT|FILE.lua|FILE.roil"},
        APP_ASSETS_ROW(&j.assets),
        POPT_AUTOHELP POPT_TABLEEND};
    return app_run(argc, argv, "roil new", "NAME [--from EFFECT]", options,
                   &(app_task){.job = &j, .check = new_check, .run = make});
}
