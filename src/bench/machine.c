// Describes where and when something was measured.
#include "base/file.h"
#include "base/memory.h"
#include "base/worker.h"
#include "bench/sweep.h"
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

enum { FILE_MAX = 1 << 20, SHOWN_DIGITS = 7 };

// Returns the value of a line "name : value" or NAME="value" of a system file; "" when it is
// missing.
static const char *line_of(const char *file, const char *name, arena *memory) {
    char line[1024];
    const char *found = "";
    size_t length = strlen(name);
    FILE *in = fopen(file, "re");
    while (in && !found[0] && fgets(line, sizeof line, in)) {
        if (strncmp(line, name, length) != 0) continue;
        char *at = line + length + strspn(line + length, " \t:=\"");
        at[strcspn(at, "\"\n")] = '\0';
        found = arena_string(memory, at);
    }
    if (in) fclose(in);
    return found;
}

static const char *system_name(arena *memory) {
    struct utsname u;
    const char *release = line_of("/etc/os-release", "PRETTY_NAME", memory);
    if (uname(&u) != 0) return release;
    return arena_format(memory, "%s%s%s %s", release, release[0] ? ", " : "", u.sysname, u.release);
}

static char *read_line(const char *folder, const char *name) { // mem_free; NULL: not there
    char path[PATH_CAP];
    void *data;
    size_t size;
    if (!path_join(path, folder, name) || !file_read(path, FILE_MAX, &data, &size)) return NULL;
    char *text = data;
    text[strcspn(text, "\r\n")] = '\0';
    return text;
}

// "HASH refs/heads/main" in packed-refs.
static char *find_packed(const char *git, const char *reference) {
    char path[PATH_CAP], line[1024];
    char *found = NULL;
    FILE *in = path_join(path, git, "packed-refs") ? fopen(path, "re") : NULL;
    while (in && !found && fgets(line, sizeof line, in)) {
        line[strcspn(line, "\n")] = '\0';
        char *space = strchr(line, ' ');
        if (space && strcmp(space + 1, reference) == 0) {
            *space = '\0';
            found = mem_copy(line, strlen(line) + 1);
        }
    }
    if (in) fclose(in);
    return found;
}

static char *checked_out(const char *home) { // mem_free; NULL: not known
    char git[PATH_CAP];
    if (!path_join(git, home, ".git")) return NULL;
    char *head = read_line(git, "HEAD");
    if (!head || strncmp(head, "ref: ", 5) != 0) return head;
    char *hash = read_line(git, head + 5);
    if (!hash) hash = find_packed(git, head + 5);
    mem_free(head);
    return hash;
}

const char *bench_commit(const char *home, arena *memory) {
    char *hash = read_line(home, "commit"); // of a package
    if (!hash) hash = checked_out(home);
    size_t digits = hash ? strspn(hash, "0123456789abcdef") : 0;
    const char *commit =
        digits >= SHOWN_DIGITS ? arena_format(memory, "%.*s", SHOWN_DIGITS, hash) : "";
    mem_free(hash);
    return commit;
}

void bench_describe_machine(bench_results *r) {
    char date[32] = "";
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc)) strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    r->cpu = line_of("/proc/cpuinfo", "model name", &r->memory);
    r->cores = worker_cores();
    r->os = system_name(&r->memory);
    r->date = arena_string(&r->memory, date);
}
