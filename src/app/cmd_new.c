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

static int make(char *folder, const char *from, const char *const *assets) {
    while (strlen(folder) > 1 && str_ends_with(folder, "/")) folder[strlen(folder) - 1] = '\0';
    const char *name = name_of(folder);
    if (!name || !is_free(folder)) return app_fail_input();
    char file[PATH_CAP];
    roil *r = roil_create(&(roil_desc){.no_device = true, .assets = assets});
    bool own = str_ends_with(from, ".lua") || str_ends_with(from, ".roil");
    bool found = r && (own ? app_check_effect(from) && str_copy(file, sizeof file, from)
                           : starts_find(roil_home(r), from, file));
    int status = found && make_all(r, file, folder, name) ? APP_DONE : app_fail_input();
    roil_destroy(r);
    return status;
}

int cmd_new(int argc, const char **argv) {
    const char *from = "campfire", **assets = NULL;
    const struct poptOption options[] = {
        {"from", '\0', POPT_ARG_STRING, &from, 0,
         "what it begins as: campfire, fire, smoke, burst, or one of `roil info effects` (default: "
         "campfire)",
         "EFFECT|FILE.lua|FILE.roil"},
        APP_ASSETS_ROW(&assets),
        POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = app_options("roil new", argc, argv, options, "NAME [--from EFFECT]");
    int code = poptGetNextOpt(context), status;
    const char *name = poptGetArg(context), *more = poptGetArg(context);
    if (code < -1) {
        app_refuse_option(context, options, code);
        status = app_fail(APP_BAD_USAGE, "new: %s", roil_error());
    } else if (!name || more) {
        status = app_fail(APP_BAD_USAGE, "new: one name is needed, as in `roil new my-fire`");
    } else {
        char *folder = mem_copy(name, strlen(name) + 1);
        status = make(folder, from, assets);
        mem_free(folder);
    }
    poptFreeContext(context);
    return status;
}
