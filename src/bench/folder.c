// Temporary folders: copies of effects that are edited, caches that begin empty.
#include "base/error.h"
#include "base/file.h"
#include "bench/run_parts.h"
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

extern char **environ;

bool bench_folder_make(char out[PATH_CAP]) {
    const char *place = getenv("TMPDIR");
    if (!path_join(out, place && place[0] ? place : "/tmp", "roil-bench-XXXXXX")) return false;
    return mkdtemp(out) || err_set("%s: cannot be made: %s", out, strerror(errno));
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

void bench_folder_remove(const char *folder) {
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

bool bench_spawn(const char *const *arguments, const char *log, int *status) {
    posix_spawn_file_actions_t actions;
    pid_t child;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    int failed =
        posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed) return err_set("%s: cannot be run: %s", arguments[0], strerror(failed));
    while (waitpid(child, status, 0) < 0)
        if (errno != EINTR) return err_set("%s: %s", arguments[0], strerror(errno));
    return true;
}

bool bench_folder_copy(const char *from, const char *to) {
    char all[PATH_CAP], log[PATH_CAP];
    int status;
    if (!path_join(all, from, ".") || !path_join(log, to, "copy.log")) return false;
    const char *const arguments[] = {"cp", "-rL", "--", all, to, NULL};
    if (!bench_spawn(arguments, log, &status)) return false;
    return status == 0 || err_set("%s: cannot be copied to %s", from, to);
}
