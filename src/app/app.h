// The program `roil`: a command each, all of it through roil.h.
#pragma once
#include "base/arena.h"
#include "roil.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { APP_DONE = 0, APP_BAD_INPUT = 1, APP_BAD_USAGE = 2, APP_DIFFERS = 3 };

int cmd_render(int argc, const char **argv);
int cmd_check(int argc, const char **argv);
int cmd_info(int argc, const char **argv);
int cmd_export(int argc, const char **argv);
int export_vdb(int argc, const char **argv); // cmd_export
int cmd_compare(int argc, const char **argv);
int cmd_bench(int argc, const char **argv);
int cmd_tune(int argc, const char **argv);
int cmd_live(int argc, const char **argv);

// One line "roil: message" on stderr; returns the status.
int app_fail(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));
int app_fail_input(void); // with roil_error()

// What may hold texts of files: terminals obey none of it (str_make_printable).
void app_print(FILE *out, const char *format, ...) __attribute__((format(printf, 2, 3)));

// ---- options ----------------------------------------------------------------------------------

struct poptOption;
struct poptContext_s;
// False, with a message for the error `code` of poptGetNextOpt: an unknown option gets the nearest
// of `options`, or all of them.
bool app_refuse_option(struct poptContext_s *context, const struct poptOption *options, int code);

// ---- frames -----------------------------------------------------------------------------------

typedef struct app_frames {
    double *numbers;
    size_t count;
    double step; // between the first two; 1 for one frame
} app_frames;
// "30", "10,30,50", "1-100", "1-100:2", or a list of such. False with a message when it is none.
bool app_parse_frames(const char *text, app_frames *out);
void app_free_frames(app_frames *frames);
// Frames that the effect says nothing of may be wanted, but are more often a slip.
void app_warn_of_frames(const app_frames *frames, const roil_effect_info *info);
void app_warn_of_trouble(const roil_effect *e); // that a simulation is in

bool app_parse_size(const char *text, uint32_t *width, uint32_t *height); // "960x540"

// "out/%04d.png" with a frame number; a pattern without a % stays as it is. Patterns are checked by
// app_check_pattern first: at most one %, of the form %d or %04d.
bool app_check_pattern(const char *pattern);
bool app_has_number(const char *pattern);
void app_format_pattern(const char *pattern, double frame, char *out, size_t capacity);
// What cannot be written is said before the work begins, not after it. Devices and pipes are for
// whoever writes them.
bool app_can_write(const char *file);
// Where results go by default, the user has named nothing: no link leads them out of the current
// folder, and no device or pipe stands there.
bool app_may_write_here(const char *path);

// As a shell takes it: in quotes where it has to be, and never an option.
char *app_quoted(arena *memory, const char *text);

bool app_parse_samples(const char *text, uint32_t *out); // of a reference: 1 to 65536 a pixel

// ---- interrupts -------------------------------------------------------------------------------

// From now on Ctrl-C is only noted, once; a second one ends the program.
void app_hear_interrupts(void);
bool app_is_interrupted(void *user); // `user` is for those who want a function of one

// ---- settings ---------------------------------------------------------------------------------

typedef struct app_settings { // --from, then --preset, then --set: what comes later wins
    const char **presets;
    size_t preset_count, preset_capacity;
    roil_setting *sets;
    size_t set_count, set_capacity;
    roil_preset **loaded;
    size_t loaded_count;
    char *events;      // of --event, as one setting of `sets`
    roil_setting *all; // after app_collect_settings
    size_t count, capacity;
} app_settings;
void app_add_preset(app_settings *s, const char *preset);
bool app_add_set(app_settings *s, char *text);         // "NAME=VALUE", cut at its '='
void app_add_event(app_settings *s, const char *text); // "2.5 click 0.4 0.6"
#define APP_EVENT_ROW(VALUE)                                                                       \
    {                                                                                              \
        "event", '\0', POPT_ARG_STRING, NULL, VALUE,                                               \
            "what happens to the effect instead of its own events: SECONDS click X Y, or SECONDS " \
            "key "                                                                                 \
            "NAME [X Y]; may be given several times",                                              \
            "EVENT"                                                                                \
    }
// That a file can be an effect. False, with a message that says what it is instead.
bool app_check_effect(const char *file);
// Of an effect; reads the presets. `from` may be NULL, else outlives `s`.
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
void app_progress_step(app_progress *p, size_t done); // shows time left
void app_progress_clear(app_progress *p);             // makes way for a line of output
void app_progress_end(app_progress *p);
// Whoever works in pieces tells of them by one of these: roil_on_progress of steps of simulations,
// roil_desc.loading of files of a sequence, roil_export of frames. `user`: an app_progress, zero at
// first. False after an interrupt.
bool app_tell_steps(void *user, double done, double whole);
bool app_tell_files(void *user, double done, double whole);
bool app_tell_frames(void *user, double done, double whole);

// ---- statistics -------------------------------------------------------------------------------

typedef struct app_stats app_stats;
app_stats *app_stats_create(void);
void app_stats_add(app_stats *s, roil_effect *e, double frame, double seconds); // of the CPU clock
bool app_stats_save(const app_stats *s, const char *file, const roil *r, const char *effect,
                    uint32_t width, uint32_t height, const roil_setting *settings, size_t count);
void app_stats_print(const app_stats *s); // a table on stdout: median and 95th percentile by pass
void app_stats_destroy(app_stats *s);
// "12.5 m/s", "yes".
void app_format_readout(const roil_readout *r, char *out, size_t capacity);
