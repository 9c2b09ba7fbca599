// What the tables of commands and options say, for `man` and for shells: `roil --describe man`.
//
// A command's table lives in the command, since its rows point at what it parses into. So each
// command is run in a process of its own until it opens its options, which are then printed
// instead.
#include "app/app.h"
#include "base/memory.h"
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct description {
    const char *format;
    void (*option)(const struct poptOption *o);
    void (*begin)(const char *name, const char *usage); // before the options of a command
    void (*end)(void);
    bool (*all)(const app_command *commands, size_t count); // false: a command did not say
} description;

static const description *wanted; // NULL: the program runs as usual

// ---- a manual page ----------------------------------------------------------------------------

// Writes a text so that roff takes none of it as a request, an escape or a hyphen to break at.
static void put_roff(const char *text) {
    if (*text == '.' || *text == '\'') fputs("\\&", stdout);
    for (; *text; text++) {
        if (*text == '\\')
            fputs("\\e", stdout);
        else if (*text == '-')
            fputs("\\-", stdout);
        else
            putchar(*text);
    }
}

static void man_begin(const char *name, const char *usage) {
    fputs(".PP\n.B ", stdout);
    put_roff(name);
    putchar('\n');
    put_roff(usage);
    putchar('\n');
}

static void man_option(const struct poptOption *o) {
    fputs(".TP\n", stdout);
    if (o->shortName) printf("\\fB\\-%c\\fR, ", o->shortName);
    fputs("\\fB\\-\\-", stdout);
    put_roff(o->longName);
    fputs("\\fR", stdout);
    if (o->argDescrip) {
        fputs(" \\fI", stdout);
        put_roff(o->argDescrip);
        fputs("\\fR", stdout);
    }
    putchar('\n');
    put_roff(o->descrip ? o->descrip : "");
    putchar('\n');
}

static void man_end(void) {}

// ---- completion -------------------------------------------------------------------------------

static void bash_begin(const char *name, const char *usage) {
    (void)usage;
    printf("    '%s') words='--help", name + strlen("roil "));
}

static void bash_option(const struct poptOption *o) {
    printf(" --%s", o->longName);
}

static void bash_end(void) {
    puts("' ;;");
}

// Writes a text within single quotes, and without what _arguments takes as its own.
static void put_zsh(const char *text) {
    for (; *text; text++) {
        if (*text == '\'')
            fputs("'\\''", stdout);
        else if (strchr("[]:\\", *text))
            printf("\\%c", *text);
        else
            putchar(*text);
    }
}

static void zsh_begin(const char *name, const char *usage) {
    (void)usage;
    printf("    '%s') _arguments '--help[list the options]'", name + strlen("roil "));
}

static void zsh_option(const struct poptOption *o) {
    fputs(" \\\n        '*--", stdout);
    put_zsh(o->longName);
    putchar('[');
    put_zsh(o->descrip ? o->descrip : "");
    putchar(']');
    if (o->argDescrip) {
        putchar(':');
        put_zsh(o->argDescrip);
        fputs(":_files", stdout);
    }
    putchar('\'');
}

static void zsh_end(void) {
    puts(" \\\n        '*:file:_files' ;;");
}

// ---- all of them ------------------------------------------------------------------------------

static void describe_rows(const struct poptOption *options) {
    for (const struct poptOption *o = options; o->longName || o->shortName || o->arg; o++) {
        if (o->arg == poptHelpOptions) continue;
        if ((o->argInfo & POPT_ARG_MASK) == POPT_ARG_INCLUDE_TABLE)
            describe_rows(o->arg);
        else if (o->longName)
            wanted->option(o);
    }
}

poptContext app_options(const char *name, int argc, const char **argv,
                        const struct poptOption *options, const char *usage) {
    if (wanted) {
        wanted->begin(name, usage);
        describe_rows(options);
        wanted->end();
        exit(fflush(stdout) == 0 ? APP_DONE : APP_BAD_INPUT);
    }
    poptContext context = poptGetContext(name, argc, argv, options, 0);
    poptSetOtherOptionHelp(context, usage);
    return context;
}

static bool describe_command(int (*run)(int argc, const char **argv), const char *name) {
    const char *arguments[] = {name, NULL};
    int status = 0;
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) _exit(run(1, arguments));
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

static bool describe_commands(const app_command *commands, size_t count) {
    bool done = true;
    for (size_t i = 0; i < count; i++)
        done = describe_command(commands[i].run, commands[i].name) && done;
    return describe_command(export_vdb, "vdb") && describe_command(export_sheet, "sheet") && done;
}

static bool describe_man(const app_command *commands, size_t count) {
    printf(".TH ROIL 1 \"\" \"roil %s\"\n.SH NAME\nroil \\- fire and smoke from one Lua file\n"
           ".SH SYNOPSIS\n.B roil\n.I COMMAND\n[\\fIoptions\\fR]\n.SH COMMANDS\n",
           roil_version());
    for (size_t i = 0; i < count; i++) {
        printf(".TP\n.B %s\n", commands[i].name);
        put_roff(commands[i].help);
        putchar('\n');
    }
    puts(".SH OPTIONS");
    bool done = describe_commands(commands, count);
    puts(".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\nbad input\n.TP\n2\nbad usage\n.TP\n3\npictures "
         "differ by more than a limit");
    return done;
}

static bool describe_bash(const app_command *commands, size_t count) {
    fputs("_roil() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words=\n"
          "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
          "        COMPREPLY=($(compgen -W '",
          stdout);
    for (size_t i = 0; i < count; i++) printf("%s ", commands[i].name);
    puts("--help --version' -- \"$word\"))\n        return\n    fi\n"
         "    case $command/${COMP_WORDS[2]} in\n"
         "    export/vdb | export/sheet) command=\"export ${COMP_WORDS[2]}\" ;;\n    esac\n"
         "    case $command in");
    bool done = describe_commands(commands, count);
    puts("    esac\n"
         "    case $word in\n"
         "    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$word\")) ;;\n"
         "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
         "    esac\n}\n"
         "complete -o filenames -F _roil roil");
    return done;
}

static bool describe_zsh(const app_command *commands, size_t count) {
    puts("#compdef roil\n_roil() {\n    local command=${words[2]}\n    local -a commands=(");
    for (size_t i = 0; i < count; i++) {
        printf("        '%s:", commands[i].name);
        put_zsh(commands[i].help);
        puts("'");
    }
    puts("    )\n    if (( CURRENT == 2 )); then\n        _describe command commands\n"
         "        return\n    fi\n"
         "    [[ $command == export && ${words[3]} == (vdb|sheet) ]] && command=\"export "
         "${words[3]}\"\n"
         "    shift words\n    (( CURRENT-- ))\n    case $command in");
    bool done = describe_commands(commands, count);
    puts("    esac\n}\n_roil \"$@\"");
    return done;
}

static const description formats[] = {
    {"man", man_option, man_begin, man_end, describe_man},
    {"bash", bash_option, bash_begin, bash_end, describe_bash},
    {"zsh", zsh_option, zsh_begin, zsh_end, describe_zsh},
};

int app_describe(const char *format, const app_command *commands, size_t count) {
    for (size_t i = 0; i < COUNT_OF(formats); i++)
        if (strcmp(formats[i].format, format) == 0) wanted = &formats[i];
    if (!wanted)
        return app_fail(APP_BAD_USAGE, "--describe '%s'; accepted: man, bash, zsh", format);
    return wanted->all(commands, count)
               ? APP_DONE
               : app_fail(APP_BAD_INPUT, "a command's options cannot be told");
}
