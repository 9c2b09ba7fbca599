#include "base/alias.h"
#include "base/memory.h"
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

typedef struct alias {
    struct alias *next;
    char *folder, *name;
} alias;

static alias *all; // the latest first
static atomic_size_t count;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

void alias_add(const char *folder, const char *name) {
    alias *a = mem_alloc(sizeof *a);
    a->folder = mem_copy(folder, strlen(folder) + 1);
    a->name = mem_copy(name, strlen(name) + 1);
    pthread_mutex_lock(&lock);
    a->next = all;
    all = a;
    count++;
    pthread_mutex_unlock(&lock);
}

void alias_remove(const char *folder) {
    pthread_mutex_lock(&lock);
    alias **at = &all, *gone = NULL;
    while (*at && strcmp((*at)->folder, folder) != 0) at = &(*at)->next;
    if (*at) {
        gone = *at;
        *at = gone->next;
        count--;
    }
    pthread_mutex_unlock(&lock);
    if (!gone) return;
    mem_free(gone->folder);
    mem_free(gone->name);
    mem_free(gone);
}

static void replace(char *text, size_t capacity, char *at, size_t length, const char *name) {
    size_t room = capacity - (size_t)(at - text), put = strlen(name);
    if (put >= room) put = room - 1;
    size_t rest = strlen(at + length), most = room - put - 1;
    if (rest > most) rest = most;
    memmove(at + put, at + length, rest);
    memcpy(at, name, put);
    at[put + rest] = '\0';
}

void alias_hide(char *text, size_t capacity) {
    if (!count) return;
    pthread_mutex_lock(&lock);
    for (const alias *a = all; a; a = a->next) {
        size_t length = strlen(a->folder), skip;
        for (char *at = text; (at = strstr(at, a->folder)); at += skip) {
            bool whole = at[length] == '/' || at[length] == '\0';
            if (whole) replace(text, capacity, at, length, a->name);
            skip = whole ? strnlen(a->name, strlen(at)) : length;
        }
    }
    pthread_mutex_unlock(&lock);
}
