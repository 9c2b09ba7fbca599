// The inside of roil_live, for src/roil_live*.c only. Three threads: that of the watch notes what
// changed and wakes the builder; the builder loads and compiles; the caller's takes over.
#pragma once
#include "base/time_limit.h"
#include "base/watch.h"
#include "roil_impl.h"
#include <pthread.h>

typedef struct live_setting { // of a control
    char *name, *text;
    char *initial; // what the script said when it was moved; NULL: given from the start
    bool preset;   // as a preset says: every build reads it again
} live_setting;

typedef struct live_result { // of a build
    effect *effect;          // NULL: it failed
    char *message;           // why; NULL: it did not
    double since;            // clock_seconds of the change that it answers
} live_result;

typedef struct live_builder { // a thread that builds
    pthread_t thread;
    roil_live *live;
    time_limit time; // of its build
    double begun;    // clock_seconds
    bool busy;       // with a build
    bool left;       // behind, while it was: what it makes is thrown away, and it ends
    bool ended;
} live_builder;

struct roil_live {
    roil *owner;
    char *file, **presets;
    size_t preset_count;
    void (*wake)(void *user);
    void *user;
    shader_library *library; // both shared by all loads
    content_cache *contents;
    watch *watch;

    // Of the caller's thread.
    roil_effect *effect;
    char *message;
    roil_live_count counts;

    pthread_mutex_t lock; // guards all below
    pthread_cond_t news;  // for the builder
    pthread_cond_t idle;  // the builder has nothing left to do
    live_setting *settings;
    size_t setting_count, setting_capacity;
    double frame;         // that will be drawn next
    bool framed;          // it is known
    bool wanted;          // something changed since the last build began
    double since, latest; // clock_seconds of the first and last change of these
    bool building, ending;
    live_builder *builder;
    size_t left;        // builders that were left behind and have not ended
    bool left_reported; // of the last of these
    live_result result; // not taken yet
    bool ready;         // there is one

    // Of the builder: files of the last good build, and those that are watched.
    char **good, **watched;
    size_t good_count, watched_count;
};

// A builder, with the lock held or before there are others. False with a message: no thread.
bool live_start(roil_live *l);
// With the lock held: settings that come from presets.
void live_drop_preset_settings(roil_live *l);
void live_add_preset_setting(roil_live *l, const roil_setting *s); // others win over it
// None of these with the lock held: asks for a build, in two steps or in one.
void live_note(roil_live *l, double when);
void live_wake(roil_live *l);
void live_want(roil_live *l);
void live_free_result(live_result *result);
void live_free_names(char **names, size_t count);
// "file:line: message" with the source line beneath, and a caret where the column can be told.
// `scripts`: the folder of the program's own. Free with mem_free.
char *live_explain(const char *message, const char *scripts);
