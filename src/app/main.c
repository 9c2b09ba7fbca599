// roil COMMAND ...: finds the command and calls it.
#include "app/app.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/words.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_SHOWN = 8 };

static const app_command commands[] = {
    {"render", cmd_render, "render frames of an effect to pictures and films"},
    {"live", cmd_live, "open a window in which an effect is tuned while it runs"},
    {"new", cmd_new, "make a folder with an effect to begin with, and all that it reads"},
    {"bundle", cmd_bundle, "pack an effect and all that it reads into one file, to give away"},
    {"check", cmd_check, "load, compile and validate effects; render nothing"},
    {"info", cmd_info, "tell about devices, passes, fields, an effect or a VDB file"},
    {"export", cmd_export,
     "write an effect as a sheet for engines, its volumes as VDB files, or a VDB sequence as raw"},
    {"bench", cmd_bench, "measure a sweep: time, memory and error over settings of effects"},
    {"tune", cmd_tune, "find the settings that are cheapest within an error, or best in a time"},
    {"repro", cmd_repro,
     "make a picture, film, volume or sheet again by what it holds, and compare"},
    {"compare", cmd_compare, "tell how different two pictures are: PSNR, SSIM, FLIP"},
};

int app_fail(int status, const char *format, ...) {
    char text[8192];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    str_make_printable(text);
    fprintf(stderr, "roil: %s\n", text);
    return status;
}

int app_close(roil *r, int status) {
    uint64_t complaints = r ? roil_validation_messages(r) : 0;
    if (status == APP_DONE && complaints)
        status =
            app_fail(APP_BAD_INPUT, "%" PRIu64 " messages of the validation layers", complaints);
    roil_destroy(r);
    return status;
}

int app_fail_input(void) {
    return app_fail(APP_BAD_INPUT, "%s", roil_error());
}

void app_print(FILE *out, const char *format, ...) {
    char *text;
    va_list args;
    va_start(args, format);
    if (vasprintf(&text, format, args) < 0) err_out_of_memory(strlen(format));
    va_end(args);
    str_make_printable(text);
    fputs(text, out);
    free(text);
}

static void print_help(FILE *out) {
    fprintf(out, "usage: roil COMMAND ...\n\n");
    for (size_t i = 0; i < COUNT_OF(commands); i++)
        fprintf(out, "  roil %-8s %s\n", commands[i].name, commands[i].help);
    fprintf(out, "\n`roil COMMAND --help` lists the options of a command.\n");
}

// Says how to begin where there are effects in the current folder.
static void print_effects(FILE *out) {
    file_list here = {0};
    const char *first = NULL;
    size_t shown = 0;
    if (!file_glob("*.lua", &here)) return;
    for (size_t i = 0; i < here.count && shown < MOST_SHOWN; i++) {
        if (!app_declares_effect(here.paths[i])) continue;
        app_print(out, shown ? ", %s" : "\nEffects here: %s", here.paths[i]);
        if (!first) first = here.paths[i];
        shown++;
    }
    if (first) app_print(out, ". Begin with `roil live %s`.\n", first);
    file_list_free(&here);
}

// Opens closed standard streams, so that files opened later do not become standard output.
static bool open_streams(void) {
    int fd;
    do fd = open("/dev/null", O_RDWR);
    while (fd >= 0 && fd <= STDERR_FILENO);
    if (fd > STDERR_FILENO) close(fd);
    return fd >= 0;
}

// Returns an error when the output could not be written.
static int main_finish(int status) {
    bool done = fflush(stdout) == 0 && !ferror(stdout);
    if (done) return status;
    return app_fail(status ? status : APP_BAD_INPUT, "standard output: cannot be written: %s",
                    strerror(errno ? errno : EIO));
}

static int main_run_command(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        print_effects(stderr);
        return APP_BAD_USAGE;
    }
    const char *wanted = argv[1];
    if (strcmp(wanted, "--help") == 0 || strcmp(wanted, "-h") == 0 || strcmp(wanted, "help") == 0) {
        print_help(stdout);
        return APP_DONE;
    }
    if (strcmp(wanted, "--version") == 0) {
        printf("roil %s\n", roil_version());
        return APP_DONE;
    }
    if (strcmp(wanted, "--describe") == 0)
        return app_describe(argc > 2 ? argv[2] : "", commands, COUNT_OF(commands));
    for (int i = 2; i < argc; i++)
        if (strcmp(argv[i], "-h") == 0) argv[i] = "--help";
    const char *names[COUNT_OF(commands)];
    for (size_t i = 0; i < COUNT_OF(commands); i++) {
        if (strcmp(commands[i].name, wanted) == 0)
            return commands[i].run(argc - 1, (const char **)argv + 1);
        names[i] = commands[i].name;
    }
    if (str_ends_with(wanted, ".lua") || str_ends_with(wanted, ".roil"))
        return app_fail(APP_BAD_USAGE, "'%s' is no command; `roil live %s` shows an effect", wanted,
                        wanted);
    words_refuse(names, COUNT_OF(names), wanted, NULL, "unknown command '%s'", wanted);
    return app_fail(APP_BAD_USAGE, "%s", err_get());
}

int main(int argc, char **argv) {
    // A tree of JSON that misses what had no memory would be written as if it were whole.
    json_set_alloc_funcs(mem_alloc, mem_free);
    err_own_process();
    log_set_target(log_to_stderr, NULL);
    int status = open_streams() ? main_finish(main_run_command(argc, argv)) : APP_BAD_INPUT;
    if (!roil_can_exit()) _exit(status);
    return status;
}
