// The inside of roil_live, for src/roil_live*.c only. There are three threads: the watch's notes
// changed files and wakes the builder; the builder loads and compiles; the caller's swaps the
// result in.
#pragma once
#include "base/time_limit.h"
#include "base/watch.h"
#include "roil/roil_impl.h"
#include <pthread.h>

typedef struct live_setting { // the setting of a control
    char *name, *text;
    char *initial; // the script's value when it was set; NULL: given from the start
    bool preset;   // it comes from a preset, which every build reads again
} live_setting;

typedef struct live_result { // the result of a build
    effect *effect;          // NULL: it failed
    char *message;           // why it failed; NULL: it did not
    double since;            // clock_seconds of the change that caused it
} live_result;

typedef struct live_builder { // a thread that builds effects
    pthread_t thread;
    roil_live *live;
    time_limit time; // limit of its build
    double begun;    // clock_seconds when its build began
    bool busy;       // it has a build to do
    bool left;       // abandoned during a build: its result is discarded, and then it ends
    bool ended;
} live_builder;

struct roil_live {
    roil *owner;
    char *file, **presets; // as the user named it
    roil_origin origin;    // where it is
    size_t preset_count;
    void (*wake)(void *user);
    void *user;
    shader_library *library; // this and `contents` are shared by all loads
    content_cache *contents;
    watch *watch;

    // Used by the caller's thread only.
    roil_effect *effect;
    char *message;
    roil_live_count counts;

    pthread_mutex_t lock; // guards everything below
    pthread_cond_t news;  // the builder has something to do
    pthread_cond_t idle;  // the builder has nothing left to do
    live_setting *settings;
    size_t setting_count, setting_capacity;
    double frame;         // the frame that will be drawn next
    bool framed;          // `frame` is known
    bool wanted;          // something changed since the last build began
    double since, latest; // clock_seconds of the first and the last of these changes
    bool building, ending;
    live_builder *builder;
    size_t left;        // builders that were left behind and have not ended
    bool left_reported; // of the last of these
    live_result result; // not taken yet
    bool ready;         // there is one

    // Used by the builder only: files of the last good build, and those that are watched.
    char **good, **watched;
    size_t good_count, watched_count;
};

// Starts a builder. Call it with the lock held, or before there is one. False with a message when
// there can be no thread.
bool live_start(roil_live *l);
// Remove and add settings that come from presets. Call them with the lock held.
void live_drop_preset_settings(roil_live *l);
void live_add_preset_setting(roil_live *l, const roil_setting *s); // a user's setting wins over it
// Request a build: live_note notes a change, live_wake wakes the builder, live_want does both. Call
// them without the lock.
void live_note(roil_live *l, double when);
void live_wake(roil_live *l);
void live_want(roil_live *l);
void live_free_result(live_result *result);
void live_free_names(char **names, size_t count);
// Returns "file:line: message" with the source line below, and a caret below that where the column
// is known. `scripts` is the folder of the library's scripts. Free it with mem_free.
char *live_explain(const char *message, const char *scripts);
