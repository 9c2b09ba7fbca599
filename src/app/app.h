// The program `roil`. Each command is a function cmd_*, which uses the library through roil.h.
#pragma once
#include "base/arena.h"
#include "roil.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { APP_DONE = 0, APP_BAD_INPUT = 1, APP_BAD_USAGE = 2, APP_DIFFERS = 3 };

int cmd_render(int argc, const char **argv);
int cmd_repro(int argc, const char **argv);
int cmd_new(int argc, const char **argv);
int cmd_bundle(int argc, const char **argv);
int cmd_check(int argc, const char **argv);
int cmd_info(int argc, const char **argv);
int cmd_export(int argc, const char **argv);
int export_vdb(int argc, const char **argv); // this and the next: cmd_export
int export_sheet(int argc, const char **argv);
int cmd_compare(int argc, const char **argv);
int cmd_bench(int argc, const char **argv);
int cmd_tune(int argc, const char **argv);
int cmd_live(int argc, const char **argv);

// One line "roil: message" on stderr; returns the status.
int app_fail(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));
int app_fail_input(void); // the same with roil_error()
// Ends `r` (NULL: none). Returns `status`, or that of a failure if validation layers complained.
int app_close(roil *r, int status);

// Prints text that may come from a file, without what a terminal would obey (str_make_printable).
void app_print(FILE *out, const char *format, ...) __attribute__((format(printf, 2, 3)));

// ---- JSON -------------------------------------------------------------------------------------

struct json_t;
// {"file", "line", "column", "message"} of roil_error(): `file` where the message names none. `r`
// may be NULL.
struct json_t *app_error_json(const roil *r, const char *file);
int app_print_json(struct json_t *root, int status); // takes the tree; returns the status

// ---- options ----------------------------------------------------------------------------------

struct poptOption;
struct poptContext_s;
struct app_settings;
struct app_frames;

// Numbers of rows whose arguments app_run takes itself; others are a command's own.
enum { APP_SET = 100, APP_PRESET, APP_EVENT, APP_FRAMES };

typedef struct app_task {
    void *job;
    bool (*check)(void *job, struct poptContext_s *arguments); // takes what is no option
    int (*run)(void *job);                                     // returns the status
    // These may be NULL.
    bool (*take)(void *job, int option, char *text); // `text` lives until the program ends
    struct app_settings *settings;                   // where APP_SET, APP_PRESET and APP_EVENT go
    struct app_frames *frames;                       // and APP_FRAMES
} app_task;
// Does a command, `name` as "roil render", from its options to its status. `usage` is what else it
// takes. What returns false with a message ends it as bad usage. Settings and frames end with it.
int app_run(int argc, const char **argv, const char *name, const char *usage,
            const struct poptOption *options, const app_task *t);
// Takes the one argument that a command has. `missing` is the message where it is not there.
bool app_take_effect(struct poptContext_s *arguments, const char **file, const char *missing);
// Opens the options of a command. As popt does for --help, it ends the program where app_describe
// asks what these options are.
struct poptContext_s *app_options(const char *name, int argc, const char **argv,
                                  const struct poptOption *options, const char *usage);

typedef struct app_command {
    const char *name;
    int (*run)(int argc, const char **argv);
    const char *help;
} app_command;
// Prints what the tables of commands and options say: as a manual page ("man"), or as what
// completes a command line ("bash", "zsh"). Returns the status.
int app_describe(const char *format, const app_command *commands, size_t count);

// ---- frames -----------------------------------------------------------------------------------

typedef struct app_frames {
    double *numbers;
    size_t count;
    double step; // distance of the first two; 1 for a single frame
} app_frames;
// Parses "30", "10,30,50", "1-100", "1-100:2", or a list of these. False with a message.
bool app_parse_frames(const char *text, app_frames *out);
void app_free_frames(app_frames *frames);
// Warns of frames outside of the effect's timeline, which are more often a mistake than wanted.
void app_warn_of_frames(const app_frames *frames, const roil_effect_info *info);
void app_warn_of_trouble(const roil_effect *e); // warns of the trouble of a simulation

bool app_parse_size(const char *text, uint32_t *width, uint32_t *height); // "960x540"

// Inserts a frame number into a pattern such as "out/%04d.png"; a pattern without a % stays the
// same. app_check_pattern must accept it first: at most one %, of the form %d or %04d.
bool app_check_pattern(const char *pattern);
bool app_has_number(const char *pattern);
void app_format_pattern(const char *pattern, double frame, char *out, size_t capacity);
// Checks before the work begins whether a file can be written. False with a message. Devices and
// pipes are not checked.
bool app_can_write(const char *file);
// Checks a default path of results, which the user has not named: no link may lead out of the
// current folder, and the path must not be a device or a pipe.
bool app_may_write_here(const char *path);

// Quotes a text for a shell where necessary, so that it is never taken as an option.
char *app_quoted(arena *memory, const char *text);

bool app_parse_samples(const char *option, const char *text, uint32_t *out); // 1 to 65536 a pixel
bool app_check_shutter(double frames);                                       // 0 to 1

// ---- parts of the work, for machines that share it --------------------------------------------

bool app_parse_shard(const char *text, unsigned *shard, unsigned *shards); // "2/4": from 1
// Keeps a part of the frames: a run of neighbours, so that what simulates goes on within it.
void app_cut_frames(app_frames *frames, unsigned shard, unsigned shards);
// Removes the frames for which `there` returns true.
void app_skip_frames(app_frames *frames, bool (*there)(void *user, double frame), void *user);
// Continues from the file of the pattern that has the highest number up to `most`, and can be read.
// False: there is none, and all begins anew. `*frame`: rendered last before it was saved.
bool app_restore_last(roil_effect *e, const char *pattern, double most, double *frame);

// ---- interrupts -------------------------------------------------------------------------------

// From now on the first Ctrl-C is only noted; a second one ends the program.
void app_hear_interrupts(void);
bool app_is_interrupted(void *user); // `user` is ignored; it makes this usable as a callback

// ---- settings ---------------------------------------------------------------------------------

typedef struct app_settings { // --from, then --preset, then --set: later ones win
    const char **presets;
    size_t preset_count, preset_capacity;
    roil_setting *sets;
    size_t set_count, set_capacity;
    roil_preset **loaded;
    size_t loaded_count;
    char *events;      // all --event, as one setting of `sets`
    roil_setting *all; // after app_collect_settings
    size_t count, capacity;
} app_settings;
void app_add_preset(app_settings *s, const char *preset);
bool app_add_set(app_settings *s, char *text);         // "NAME=VALUE", cut at its '='
void app_add_event(app_settings *s, const char *text); // "2.5 click 0.4 0.6"
#define APP_EVENT_ROW                                                                              \
    {                                                                                              \
        "event", '\0', POPT_ARG_STRING, NULL, APP_EVENT,                                           \
            "an event that replaces the effect's own events: SECONDS click X Y, or SECONDS key "   \
            "NAME [X Y]; may be given several times",                                              \
            "EVENT"                                                                                \
    }
// Checks that a file can be an effect. False with a message that says what it is instead.
bool app_check_effect(const char *file);
bool app_declares_effect(const char *file); // a Lua file that is no module and no sweep
typedef struct app_export {                 // of an effect: what `roil export vdb` and `sheet` do
    const struct app_device *device;        // device_options.h
    app_settings *settings;
    const char *file;
    bool (*plan)(void *job, roil_effect *e); // completes the job; false with a message: bad usage
    // Draws with the effect, which is then loaded anew; false with a message: bad input. May be
    // NULL.
    bool (*look)(void *job, roil_effect *e);
    bool (*make)(void *job, roil_effect *e); // false with a message: bad input
    void *job;
} app_export;
int app_export_effect(const app_export *x); // loads the effect, plans, makes; returns the status
// Reads the presets and collects all settings of an effect. `from` may be NULL; else it must
// outlive `s`.
bool app_collect_settings(app_settings *s, roil *r, const char *effect, const roil_recipe *from);
void app_free_settings(app_settings *s);

// ---- progress ---------------------------------------------------------------------------------

typedef struct app_progress {
    double start, printed;
    size_t total;
    const char *unit; // "frames"
    bool terminal;
} app_progress;
void app_progress_begin(app_progress *p, size_t total, const char *unit);
void app_progress_step(app_progress *p, size_t done); // shows the time left
void app_progress_clear(app_progress *p);             // clears the line for other output
void app_progress_end(app_progress *p);
// Callbacks that show progress: for roil_on_progress (steps), roil_desc.loading (files of a
// sequence) and roil_export (frames). `user` is an app_progress, zero at first. They return false
// after an interrupt.
bool app_tell_steps(void *user, double done, double whole);
bool app_tell_files(void *user, double done, double whole);
bool app_tell_frames(void *user, double done, double whole);

// ---- statistics -------------------------------------------------------------------------------

typedef struct app_stats app_stats;
app_stats *app_stats_create(void);
void app_stats_add(app_stats *s, roil_effect *e, double frame, double seconds); // of the CPU clock
bool app_stats_save(const app_stats *s, const char *file, const roil *r, const char *effect,
                    uint32_t width, uint32_t height, const roil_setting *settings, size_t count);
void app_stats_print(const app_stats *s); // prints median and 95th percentile of each pass
void app_stats_destroy(app_stats *s);
// Prints a value with its unit: "12.5 m/s", "yes".
void app_format_readout(const roil_readout *r, char *out, size_t capacity);
