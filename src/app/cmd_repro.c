// roil repro FILE: makes an output again as its recipe says, and compares.
#include "app/app.h"
#include "app/arguments.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <popt.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { UUID_AT = 21, UUID_SIZE = 36 }; // of a VDB file

typedef struct job {
    const char *file, *named, *output; // what it was made of; its effect by the user; NULL: none
    app_device device;
    roil_made *made;
    char folder[PATH_CAP]; // of the new file
    const char *again;     // that
    arena memory;
    arguments list; // of the command that makes it
} job;

static bool is_whole(double frame) {
    return frame == rint(frame) && frame >= 0;
}

// The frames as the command takes them: of a volume also those that its box was chosen by.
static const char *frames_of(job *j) {
    const roil_made *m = j->made;
    if (strcmp(m->kind, "film") == 0 && m->last > m->first)
        return arena_format(&j->memory, "%.0f-%.0f:%.0f", m->first, m->last, m->step);
    strbuf out = {0};
    if (m->first < m->frame) strbuf_add(&out, "%.0f,", m->first);
    strbuf_add(&out, "%.0f", m->frame);
    if (m->last > m->frame) strbuf_add(&out, ",%.0f", m->last);
    const char *kept = arena_string(&j->memory, strbuf_text(&out));
    strbuf_free(&out);
    return kept;
}

static void add_render(job *j, const char *effect) {
    static const char dump[] = "--dump-pass=";
    const roil_made *m = j->made;
    const char *image = NULL;
    const char *beside = arena_format(&j->memory, "%s/picture.png", j->folder);
    arguments_add(&j->list, "roil");
    arguments_add(&j->list, "render");
    arguments_add(&j->list, arena_format(&j->memory, "--size=%ux%u", m->width, m->height));
    for (size_t i = 0; i < m->option_count; i++)
        if (strncmp(m->options[i], dump, sizeof dump - 1) == 0)
            image = m->options[i] + sizeof dump - 1;
        else
            arguments_add(&j->list, m->options[i]);
    arguments_add(&j->list, "--output");
    arguments_add(&j->list, image ? beside : j->again);
    if (image) arguments_add(&j->list, "--dump-pass");
    if (image) arguments_add(&j->list, image);
    if (image) arguments_add(&j->list, j->again);
    arguments_add(&j->list, arena_format(&j->memory, "--frames=%s", frames_of(j)));
    arguments_add(&j->list, effect);
}

static void add_export(job *j, const char *effect) {
    const roil_made *m = j->made;
    arguments_add(&j->list, "roil");
    arguments_add(&j->list, "export");
    arguments_add(&j->list, "vdb");
    for (size_t i = 0; i < m->option_count; i++) arguments_add(&j->list, m->options[i]);
    arguments_add(&j->list, arena_format(&j->memory, "--output=%s/%%d.vdb", j->folder));
    j->again = arena_format(&j->memory, "%s/%.0f.vdb", j->folder, m->frame);
    arguments_add(&j->list, arena_format(&j->memory, "--frames=%s", frames_of(j)));
    arguments_add(&j->list, effect);
}

static void add_sheet(job *j, const char *effect) {
    const roil_made *m = j->made;
    arguments_add(&j->list, "roil");
    arguments_add(&j->list, "export");
    arguments_add(&j->list, "sheet");
    for (size_t i = 0; i < m->option_count; i++) arguments_add(&j->list, m->options[i]);
    arguments_add(&j->list, arena_format(&j->memory, "--output=%s/%s", j->folder, m->sheet));
    j->again = arena_format(&j->memory, "%s/%s", j->folder, m->part);
    if (str_ends_with(m->part, ".html"))
        arguments_add(&j->list, arena_format(&j->memory, "--page=%s", j->again));
    arguments_add(&j->list, effect);
}

// Runs the command; what it prints to the standard output is left out.
static bool make_again(job *j) {
    for (size_t i = 0; i < j->made->setting_count; i++) {
        const roil_setting *s = &j->made->settings[i];
        arguments_add(&j->list, "--set");
        arguments_add(&j->list, arena_format(&j->memory, "%s=%s", s->name, s->value));
    }
    arguments_add_device(&j->list, &j->device);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child;
    int failed = posix_spawn(&child, "/proc/self/exe", &files, NULL, j->list.list, environ);
    posix_spawn_file_actions_destroy(&files);
    int status = 1;
    while (!failed && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    bool done = !failed && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return done || err_set("%s: it cannot be made again", j->file);
}

// ---- comparison -------------------------------------------------------------------------------

typedef struct bytes {
    const uint8_t *at;
    size_t size;
} bytes;

static bool map_file(const char *path, bytes *out) {
    struct stat info;
    int file = open(path, O_RDONLY | O_CLOEXEC);
    bool done = file >= 0 && fstat(file, &info) == 0 && info.st_size > 0;
    void *at =
        done ? mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
    if (file >= 0) close(file);
    if (at == MAP_FAILED) return err_set("%s: cannot be read: %s", path, strerror(errno));
    *out = (bytes){at, (size_t)info.st_size};
    return true;
}

// Every VDB file has a number of its own, made by chance.
static bool are_same(const bytes *a, const bytes *b, bool volume) {
    if (a->size != b->size) return false;
    size_t from = volume && a->size > UUID_AT + UUID_SIZE ? UUID_AT + UUID_SIZE : 0;
    return memcmp(a->at + from, b->at + from, a->size - from) == 0 &&
           (!from || memcmp(a->at, b->at, UUID_AT) == 0);
}

static bool tell_difference(const char *what, const char *then, const char *now) {
    if (strcmp(then, now) == 0) return false;
    app_print(stdout, "%s: then %s, now %s\n", what, then, now);
    return true;
}

static int compare(const job *j) {
    bytes then = {0}, now = {0};
    if (!map_file(j->file, &then) || !map_file(j->again, &now)) return app_fail_input();
    roil_made *m = roil_read_made(j->again);
    if (!m) return app_fail_input();
    bool same = are_same(&then, &now, strcmp(m->kind, "volume") == 0);
    bool changed = tell_difference("inputs", j->made->inputs, m->inputs);
    changed |= tell_difference("roil", j->made->version, m->version);
    changed |= tell_difference("device", j->made->device, m->device);
    changed |= tell_difference("driver", j->made->driver, m->driver);
    roil_free_made(m);
    munmap((void *)then.at, then.size);
    munmap((void *)now.at, now.size);
    if (same) {
        app_print(stdout, "%s: the same, bit for bit\n", j->file);
        return APP_DONE;
    }
    roil_difference d;
    bool picture = strcmp(j->made->kind, "picture") == 0 ||
                   (strcmp(j->made->kind, "sheet") == 0 && str_ends_with(j->again, ".png"));
    if (!picture || !roil_compare(&(roil_comparison){.a = j->file, .b = j->again}, &d))
        app_print(stdout, "%s: not the same\n", j->file);
    else
        app_print(stdout, "%s: not the same file; as pictures: PSNR %.2f dB, FLIP %.5f\n", j->file,
                  d.psnr, d.flip);
    if (!changed) app_print(stdout, "Neither inputs nor roil nor the device have changed.\n");
    return APP_DIFFERS;
}

// ---- command ----------------------------------------------------------------------------------

static bool find_effect(job *j, const char **out) {
    const roil_made *m = j->made;
    *out = j->named ? j->named : m->effect;
    if (!*out)
        return err_set("%s: its effect lies outside of this folder; name it: roil repro %s "
                       "EFFECT.lua",
                       j->file, j->file);
    return app_check_effect(*out) && (j->named || path_require_inside(".", *out));
}

static bool prepare(job *j, const char **effect) {
    const char *temporary = getenv("TMPDIR");
    j->made = roil_read_made(j->file);
    if (!j->made || !find_effect(j, effect)) return false;
    const roil_made *m = j->made;
    if (!is_whole(m->frame) || !is_whole(m->first) || !is_whole(m->last) || !is_whole(m->step) ||
        m->step < 1)
        return err_set("%s: shows frame %g, between two frames, as a window plays; only frames are "
                       "made again",
                       j->file, m->frame);
    int length = snprintf(j->folder, sizeof j->folder, "%s/roil-repro-XXXXXX",
                          temporary && temporary[0] ? temporary : "/tmp");
    if (length >= (int)sizeof j->folder - 32 || !mkdtemp(j->folder)) {
        j->folder[0] = '\0';
        return err_set("no folder for what is made again: %s", strerror(errno));
    }
    j->again = arena_format(&j->memory, "%s/again.%s", j->folder, path_extension(j->file));
    return true;
}

static bool keep_output(const job *j) {
    void *data;
    size_t size;
    if (!j->output) return true;
    bool done = file_read(j->again, SIZE_MAX / 4, &data, &size);
    if (!done) return false;
    done = file_make_parent_folders(j->output) && file_write(j->output, data, size);
    mem_free(data);
    return done;
}

static void remove_folder(const job *j) {
    char pattern[PATH_CAP];
    file_list files = {0};
    if (!j->folder[0]) return;
    if (path_join(pattern, j->folder, "*") && file_glob(pattern, &files))
        for (size_t i = 0; i < files.count; i++) unlink(files.paths[i]);
    file_list_free(&files);
    rmdir(j->folder);
}

static int repro(void *user) {
    job *j = user;
    const char *effect;
    int status = APP_BAD_INPUT;
    if (!prepare(j, &effect)) {
        status = app_fail_input();
    } else {
        const roil_made *m = j->made;
        app_print(stdout, "%s: %s of %s, frame %g, roil %s on %s\n", j->file, m->kind, effect,
                  m->frame, m->version, m->device);
        fflush(stdout);
        if (strcmp(m->kind, "volume") == 0)
            add_export(j, effect);
        else if (strcmp(m->kind, "sheet") == 0)
            add_sheet(j, effect);
        else
            add_render(j, effect);
        status = make_again(j) && keep_output(j) ? compare(j) : app_fail_input();
    }
    remove_folder(j);
    roil_free_made(j->made);
    arguments_free(&j->list);
    arena_free(&j->memory);
    return status;
}

static bool repro_check(void *user, poptContext context) {
    job *j = user;
    j->file = poptGetArg(context);
    j->named = poptGetArg(context);
    if (!j->file || poptPeekArg(context))
        return err_set("one file is made again, as in `roil repro shot.png`");
    return app_check_device(&j->device);
}

int cmd_repro(int argc, const char **argv) {
    job *j = mem_alloc(sizeof *j);
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &j->output, 0, "keep what was made again", "FILE"},
        app_device_rows(&j->device),
        POPT_AUTOHELP POPT_TABLEEND};
    int status = app_run(argc, argv, "roil repro", "FILE.png|exr|mp4|vdb|json|html [EFFECT.lua]",
                         options, &(app_task){.job = j, .check = repro_check, .run = repro});
    mem_free(j);
    return status;
}
