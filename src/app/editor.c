#include "app/editor.h"
#include "base/error.h"
#include "base/memory.h"
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

enum { MOST_WORDS = 32, MOST_EDITORS = 64 };

// Returns the command of $ROIL_EDITOR, else of $VISUAL; "" when neither is set.
static const char *editor_command(void) {
    const char *own = getenv("ROIL_EDITOR"), *visual = getenv("VISUAL");
    if (own && own[0]) return own;
    return visual ? visual : "";
}

// One word, with %f and %l replaced. `*placed`: there was one of them.
static char *fill(const char *word, size_t length, const char *file, int line, bool *placed) {
    strbuf out = {0};
    for (size_t i = 0; i < length; i++) {
        char next = word[i] == '%' && i + 1 < length ? word[i + 1] : '\0';
        if (next == 'f')
            strbuf_add(&out, "%s", file);
        else if (next == 'l')
            strbuf_add(&out, "%d", line);
        else
            strbuf_append(&out, word + i, 1);
        *placed = *placed || next == 'f';
        i += next == 'f' || next == 'l';
    }
    return out.text;
}

bool editor_words(const char *command, const char *file, int line, char **out, size_t most) {
    size_t count = 0;
    bool placed = false, fits = true;
    for (const char *at = command + strspn(command, " "); *at && fits; at += strspn(at, " ")) {
        size_t length = strcspn(at, " ");
        fits = count + 3 <= most;
        if (fits) out[count++] = fill(at, length, file, line, &placed);
        at += length;
    }
    if (fits && count > 0 && !placed) {
        out[count++] = fill("+%l", 3, "", line, &placed);
        out[count++] = fill("%f", 2, file, line, &placed);
    }
    out[count] = NULL;
    return (fits && count > 0) || err_set("the editor '%s' is no command", command);
}

// Those that ended are waited for when the next one begins; the rest go on without the window.
static void reap(pid_t *editors) {
    for (size_t i = 0; i < MOST_EDITORS; i++)
        if (editors[i] > 0 && waitpid(editors[i], NULL, WNOHANG) != 0) editors[i] = 0;
}

// The editor has the window's terminal for its messages, but Ctrl-C there does not concern it.
static bool start(char **words) {
    static pid_t editors[MOST_EDITORS];
    posix_spawnattr_t how;
    pid_t editor;
    reap(editors);
    posix_spawnattr_init(&how);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);
    int error = posix_spawnp(&editor, words[0], NULL, &how, words, environ);
    posix_spawnattr_destroy(&how);
    if (error) return err_set("the editor '%s': %s", words[0], strerror(error));
    for (size_t i = 0; i < MOST_EDITORS; i++)
        if (!editors[i]) {
            editors[i] = editor;
            break;
        }
    return true;
}

bool editor_open(const char *file, int line) {
    char *words[MOST_WORDS + 1] = {NULL};
    const char *command = editor_command();
    if (!command[0])
        return err_set("%s:%d; ROIL_EDITOR names the editor that opens it, as ROIL_EDITOR='code -g "
                       "%%f:%%l'",
                       file, line);
    bool done = editor_words(command, file, line, words, MOST_WORDS) && start(words);
    for (size_t i = 0; words[i]; i++) mem_free(words[i]);
    return done;
}
