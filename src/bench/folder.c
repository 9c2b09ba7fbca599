// Temporary folders: copies of effects that are edited, and empty caches.
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include "bench/run_parts.h"
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

// Folders in use: a process that runs out of memory removes them before it ends.
enum { FOLDERS = 8 };
static char folders[FOLDERS][PATH_CAP];

static void remove_all(void) {
    for (size_t i = 0; i < FOLDERS; i++)
        if (folders[i][0]) bench_folder_remove(folders[i]);
}

static void keep_in_mind(const char *folder) {
    for (size_t i = 0; i < FOLDERS; i++)
        if (!folders[i][0]) {
            str_copy(folders[i], sizeof folders[i], folder);
            break;
        }
    err_when_out_of_memory(remove_all, false);
}

bool bench_folder_make(char out[PATH_CAP]) {
    const char *place = getenv("TMPDIR");
    if (!path_join(out, place && place[0] ? place : "/tmp", "roil-bench-XXXXXX")) return false;
    if (!mkdtemp(out)) return err_set("%s: cannot be made: %s", out, strerror(errno));
    keep_in_mind(out);
    return true;
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

// Removes a folder in another process, which has memory when this one has none.
static bool remove_apart(const char *folder) {
    static const char *const nothing[] = {NULL};
    const char *const arguments[] = {"/bin/rm", "-rf", "--", folder, NULL};
    pid_t child;
    int status;
    if (posix_spawn(&child, arguments[0], NULL, NULL, (char *const *)arguments,
                    (char *const *)nothing) != 0)
        return false;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return false;
    return status == 0;
}

void bench_folder_remove(const char *folder) {
    if (!remove_apart(folder)) nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    for (size_t i = 0; i < FOLDERS; i++)
        if (strcmp(folders[i], folder) == 0) folders[i][0] = '\0';
}

// `folder`: where it runs; below 0: here.
static bool spawn_in(int folder, const char *const *arguments, const char *log, int *status) {
    posix_spawn_file_actions_t actions;
    pid_t child;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (folder >= 0) posix_spawn_file_actions_addfchdir_np(&actions, folder);
    int failed =
        posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed) return err_set("%s: cannot be run: %s", arguments[0], strerror(failed));
    while (waitpid(child, status, 0) < 0)
        if (errno != EINTR) return err_set("%s: %s", arguments[0], strerror(errno));
    return true;
}

bool bench_spawn(const char *const *arguments, const char *log, int *status) {
    return spawn_in(-1, arguments, log, status);
}

bool bench_folder_copy(const char *inside, const char *file, const char *to) {
    char real_to[PATH_MAX], log[PATH_CAP];
    int status;
    if (!realpath(to, real_to) || !path_join(log, to, "copy.log"))
        return err_set("%s: %s", to, strerror(errno));
    int folder = file_open_folder_inside(inside, file);
    if (folder < 0) return false;
    const char *const arguments[] = {"cp", "-rP", "--", ".", real_to, NULL};
    bool done = spawn_in(folder, arguments, log, &status);
    close(folder);
    return done && (status == 0 || err_set("%s: its folder cannot be copied to %s", file, real_to));
}
