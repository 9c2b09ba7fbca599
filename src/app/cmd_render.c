// roil render EFFECT.lua ...: frames to pictures and films.
#include "app/app.h"
#include "app/device_options.h"
#include "base/arena.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <string.h>

typedef struct output {
    const char *pattern; // file or pattern
    const char *image;   // --dump-pass: which image; NULL: the picture
    roil_video *video;
    bool ours; // the default, which nobody named
} output;

typedef struct job {
    const char *file, *stats;
    const char *inside; // the folder that the effect of a recipe lies in; NULL: its user named it
    const char *checkpoint, *restore;
    output *outputs;
    size_t output_count, output_capacity;
    roil_writer *writer; // of pictures
    const char *from_file;
    roil_recipe *from; // of that picture
    app_settings settings;
    app_device device;
    app_frames frames;
    uint32_t width, height;
    int alpha, premultiplied, sixteen, full, shown;
    int warmup;             // frames
    unsigned shard, shards; // 0: all frames
    int skips, simulates;   // --skip-existing, --simulate-only
    int checkpoint_every;   // frames; 0: after the last alone
    size_t left_out;        // frames that were there
    bool all;               // frames, as nobody says which
    uint32_t reference;     // samples a pixel; 0: as the effect draws it
    uint32_t samples;       // pictures that a frame is averaged of; 0: it is not
    double shutter;         // frames
    double fps;
    char default_output[PATH_CAP];
} job;

// ---- options ----------------------------------------------------------------------------------

enum {
    OPTION_OUTPUT = 1,
    OPTION_SIZE,
    OPTION_DUMP,
    OPTION_REFERENCE,
    OPTION_SAMPLES,
    OPTION_SHARD,
};

static bool add_output(job *j, const char *pattern, const char *image) {
    const char *extension = path_extension(pattern);
    bool video = roil_is_film(pattern);
    if (strcmp(extension, "png") != 0 && strcmp(extension, "exr") != 0 && (!video || image))
        return err_set("output '%s'; accepted: .png, .exr%s", pattern,
                       image ? "" : ", .mp4, .webm, .mov, .gif, .apng");
    if (!app_check_pattern(pattern)) return false;
    *MEM_ADD(j->outputs, j->output_count, j->output_capacity) =
        (output){.pattern = pattern, .image = image};
    return true;
}

static bool take_option(void *user, int option, char *text) {
    job *j = user;
    switch (option) {
    case OPTION_OUTPUT:
        return add_output(j, text, NULL);
    case OPTION_SIZE:
        return app_parse_size(text, &j->width, &j->height);
    case OPTION_REFERENCE:
        return app_parse_samples("--reference", text, &j->reference);
    case OPTION_SAMPLES:
        return app_parse_samples("--samples", text, &j->samples);
    case OPTION_SHARD:
        return app_parse_shard(text, &j->shard, &j->shards);
    case OPTION_DUMP: { // NAME and FILE, joined by join_dump
        char *file = strchr(text, '\n');
        if (!file) return err_set("--dump-pass wants NAME FILE");
        *file = '\0';
        return add_output(j, file + 1, text);
    }
    }
    return true;
}

// popt only knows options with one argument, so "--dump-pass NAME FILE" becomes one text with a
// line break between the two.
static const char **join_dump(int *argc, const char **argv, arena *memory) {
    const char **joined = arena_alloc(memory, ((size_t)*argc + 1) * sizeof *joined);
    int count = 0;
    for (int i = 0; i < *argc; i++) {
        joined[count++] = argv[i];
        if (strcmp(argv[i], "--dump-pass") != 0 || i + 2 >= *argc) continue;
        joined[count++] = arena_format(memory, "%s\n%s", argv[i + 1], argv[i + 2]);
        i += 2;
    }
    *argc = count;
    return joined;
}

// Checks what cuts the work into parts.
static bool render_check_parts(const job *j) {
    if (j->checkpoint_every < 0)
        return err_set("--checkpoint-every %d; accepted: 1 or more frames", j->checkpoint_every);
    if (j->checkpoint_every && !j->checkpoint)
        return err_set("--checkpoint-every: where to? --checkpoint state/%%04d.state names it");
    if (j->simulates && !j->checkpoint)
        return err_set("--simulate-only leaves nothing without --checkpoint FILE");
    if (j->simulates && (j->output_count || j->skips || j->reference))
        return err_set("--simulate-only draws no pictures: leave out -o, --dump-pass, "
                       "--skip-existing and --reference");
    for (size_t i = 0; (j->shards || j->skips) && i < j->output_count; i++)
        if (str_ends_with(j->outputs[i].pattern, ".mp4"))
            return err_set("output '%s': a film is not drawn in parts; draw pictures, as "
                           "out/%%04d.png",
                           j->outputs[i].pattern);
    return (!j->checkpoint || app_check_pattern(j->checkpoint)) &&
           (!j->restore || app_check_pattern(j->restore));
}

static bool render_check(void *user, poptContext arguments) {
    job *j = user;
    if ((poptPeekArg(arguments) || !j->from_file) &&
        !app_take_effect(arguments, &j->file,
                         "which effect? usage: roil render EFFECT.lua [options]"))
        return false;
    if (j->warmup < 0 || j->warmup > 100000)
        return err_set("--warmup %d; accepted: 0 to 100000 frames", j->warmup);
    if (!app_check_shutter(j->shutter)) return false;
    if (j->samples && j->reference) return err_set("--samples and --reference exclude each other");
    if (j->alpha && j->premultiplied)
        return err_set("--alpha is straight, --premultiplied is not: one of the two");
    if (j->warmup && j->restore) return err_set("--warmup and --restore exclude each other");
    return render_check_parts(j) && app_check_device(&j->device);
}

// ---- work -------------------------------------------------------------------------------------

// Takes from --from what the command line does not say.
static bool complete_from(job *j) {
    if (j->from_file) {
        j->from = roil_read_recipe(j->from_file);
        if (!j->from) return false;
        bool named = j->file != NULL;
        if (!named) j->file = j->from->effect;
        if (!j->file)
            return err_set("%s: its effect lies outside of this folder; name it: roil render "
                           "EFFECT.lua --from %s",
                           j->from_file, j->from_file);
        if (!named && !path_require_inside(j->inside = ".", j->file)) return false;
    }
    if (j->from && !j->frames.count) {
        j->frames.numbers = mem_copy(&j->from->frame, sizeof j->from->frame);
        j->frames.count = 1;
    }
    if (!j->width) {
        j->width = j->from ? j->from->width : 960;
        j->height = j->from ? j->from->height : 540;
    }
    return true;
}

static bool name_file(const output *o, double frame, char file[PATH_CAP]) {
    app_format_pattern(o->pattern, frame, file, PATH_CAP);
    return !o->ours || app_may_write_here(file);
}

static bool is_there(void *user, double frame) {
    const job *j = user;
    char file[PATH_CAP];
    for (size_t i = 0; i < j->output_count; i++)
        if (!name_file(&j->outputs[i], frame, file) || !file_exists(file) || !roil_is_whole(file))
            return false;
    return true;
}

// Takes from the effect what the user does not say: all of its frames, and the default output.
static bool render_complete(job *j, roil_effect *e) {
    roil_effect_info info = roil_get_info(e);
    char range[64];
    snprintf(range, sizeof range, "%u-%u", info.first_frame, info.first_frame + info.frames - 1);
    j->all = !j->frames.count;
    if (j->all && !app_parse_frames(range, &j->frames)) return false;
    app_warn_of_frames(&j->frames, &info);
    if (!(j->fps > 0)) j->fps = info.fps / j->frames.step;
    if (j->shards) app_cut_frames(&j->frames, j->shard, j->shards);
    if (j->shards) j->all = false;
    bool picture = j->simulates;
    for (size_t i = 0; i < j->output_count; i++) picture = picture || !j->outputs[i].image;
    if (!picture) {
        int length;
        const char *name = path_stem(j->file, &length);
        snprintf(j->default_output, sizeof j->default_output, "out/%.*s/%%04d.png", length, name);
        if (!add_output(j, j->default_output, NULL)) return false;
        j->outputs[j->output_count - 1].ours = true;
    }
    for (size_t i = 0; i < j->output_count; i++) {
        const output *o = &j->outputs[i];
        bool one_file = !app_has_number(o->pattern) && !roil_is_film(o->pattern);
        if (one_file && j->frames.count > 1)
            return err_set("output '%s' would be overwritten by each of %zu frames; name it like "
                           "out/%%04d.png",
                           o->pattern, j->frames.count);
    }
    size_t before = j->frames.count;
    if (j->skips) app_skip_frames(&j->frames, is_there, j);
    j->left_out = before - j->frames.count;
    return true;
}

static bool is_simulated(void *user, double frame) {
    return frame <= *(const double *)user;
}

// Restores the last checkpoint before the frames; where only their states are wanted, the last of
// all.
static void render_restore_last(job *j, roil_effect *e) {
    double last, most = j->frames.numbers[j->simulates ? j->frames.count - 1 : 0];
    if (!app_restore_last(e, j->restore, j->simulates ? most : most - 1, &last)) return;
    size_t before = j->frames.count;
    if (j->simulates) app_skip_frames(&j->frames, is_simulated, &last);
    j->left_out += before - j->frames.count;
}

// Restores the checkpoint, and skips the frames that it already contains.
static bool render_restore(job *j, roil_effect *e) {
    double last, *numbers = j->frames.numbers;
    size_t left = 0;
    if (app_has_number(j->restore)) {
        render_restore_last(j, e);
        return true;
    }
    if (!roil_restore(e, j->restore, &last)) return false;
    for (size_t i = 0; j->all && i < j->frames.count; i++)
        if (numbers[i] > last) numbers[left++] = numbers[i];
    if (j->all) j->frames.count = left;
    if (!j->frames.count) return err_set("%s: is of frame %g, the last", j->restore, last);
    return numbers[0] > last || err_set("%s: is of frame %g; frames after it are accepted, not %g",
                                        j->restore, last, numbers[0]);
}

static bool open_outputs(job *j, roil_effect *e) {
    for (size_t i = 0; i < j->output_count; i++) {
        output *o = &j->outputs[i];
        if (o->image && !roil_keep(e, o->image)) return false;
    }
    if (j->samples && !roil_set_samples(e, j->samples, j->shutter)) return false;
    if (!roil_prepare(e, j->width, j->height) || (j->restore && !render_restore(j, e)))
        return false;
    if (j->simulates) roil_only_simulate(e);
    j->writer = roil_writer_create();
    if (!j->writer) return false;
    if (!j->frames.count) return true;
    for (size_t i = 0; i < j->output_count; i++) {
        output *o = &j->outputs[i];
        bool film = roil_is_film(o->pattern);
        char file[PATH_CAP];
        if (!name_file(o, j->frames.numbers[0], file)) return false;
        if (!film && !app_can_write(file)) return false;
        if (!film) continue;
        o->video = roil_video_create(e, o->pattern, j->fps, j->alpha);
        if (!o->video) return false;
    }
    char state[PATH_CAP];
    if (j->checkpoint) app_format_pattern(j->checkpoint, j->frames.numbers[0], state, PATH_CAP);
    return (!j->checkpoint || app_can_write(state)) && (!j->stats || app_can_write(j->stats));
}

static bool save_frame(job *j, roil_effect *e, double frame) {
    for (size_t i = 0; i < j->output_count; i++) {
        output *o = &j->outputs[i];
        char file[PATH_CAP];
        if (!name_file(o, frame, file)) return false;
        roil_save_options options = {.image = o->image,
                                     .alpha = j->alpha,
                                     .premultiplied = j->premultiplied,
                                     .sixteen = j->sixteen,
                                     .full = j->full,
                                     .shown = j->shown};
        bool done =
            o->video ? roil_video_add(o->video) : roil_writer_save(j->writer, e, file, &options);
        if (!done) return false;
    }
    return true;
}

// Draws the frames before number `index` of the job, as many as were asked for and exist, unless
// they were drawn just now.
static bool warm_up(const job *j, roil_effect *e, size_t index) {
    const double *frames = j->frames.numbers;
    if (index > 0 && frames[index] == frames[index - 1] + 1) return true;
    for (int before = j->warmup; before > 0; before--) {
        double frame = frames[index] - before;
        if (frame >= roil_get_info(e).first_frame && !roil_render(e, frame)) return false;
    }
    return true;
}

// Draws a frame; of a reference, until it has its samples.
static bool render_frame(const job *j, roil_effect *e, size_t index, app_progress *progress) {
    double frame = j->frames.numbers[index];
    size_t before = index * j->reference;
    bool done = roil_render(e, frame);
    while (done && roil_samples(e) < j->reference) {
        if (!roil_samples(e))
            return err_set("%s: its picture does not show what a pass `march` draws", j->file);
        app_progress_step(progress, before + roil_samples(e));
        done = roil_advance(e, frame);
    }
    return done;
}

// Keeps the state after each N-th frame of the effect, whichever was drawn first, and after the
// last.
static bool keep_state(const job *j, roil_effect *e, size_t index) {
    double frame = j->frames.numbers[index], number = frame - roil_get_info(e).first_frame + 1;
    bool last = index + 1 == j->frames.count;
    bool each = j->checkpoint_every && fmod(number, j->checkpoint_every) == 0;
    char file[PATH_CAP];
    if (!j->checkpoint || (!last && !each)) return true;
    app_format_pattern(j->checkpoint, frame, file, sizeof file);
    return file_make_parent_folders(file) && roil_checkpoint(e, file);
}

static bool render_frames(job *j, roil_effect *e, app_stats *stats) {
    app_progress progress, steps = {0};
    roil_on_progress(e, app_tell_steps, &steps);
    size_t each = j->reference ? j->reference : 1; // steps of the progress
    app_progress_begin(&progress, each * j->frames.count, j->reference ? "samples" : "frames");
    bool done = true;
    app_hear_interrupts();
    for (size_t i = 0; done && i < j->frames.count; i++) {
        if (app_is_interrupted(NULL))
            done = err_set("stopped after %zu of %zu frames", i, j->frames.count);
        if (!done) break;
        double frame = j->frames.numbers[i], start = clock_seconds();
        done = warm_up(j, e, i) && render_frame(j, e, i, &progress) && save_frame(j, e, frame) &&
               keep_state(j, e, i);
        if (!done) break;
        app_stats_add(stats, e, frame, clock_seconds() - start);
        app_progress_step(&progress, (i + 1) * each);
    }
    app_progress_end(&progress);
    if (done) app_warn_of_trouble(e);
    return done;
}

// Waits until all files are written.
static bool close_outputs(job *j, bool done) {
    if (!roil_writer_finish(j->writer)) done = false;
    j->writer = NULL;
    for (size_t i = 0; i < j->output_count; i++) {
        output *o = &j->outputs[i];
        if (!o->video) continue;
        if (done)
            done = roil_video_finish(o->video);
        else
            roil_video_abandon(o->video);
        o->video = NULL;
    }
    return done;
}

static int render_run(void *user) {
    job *j = user;
    if (!complete_from(j)) return app_fail_input();
    roil_desc desc = app_device_desc(&j->device);
    desc.counters = j->stats != NULL;
    desc.reference = j->reference;
    app_progress files = {0};
    desc.loading = app_tell_files;
    desc.user = &files;
    roil *r = roil_create(&desc);
    bool collected = r && app_collect_settings(&j->settings, r, j->file, j->from);
    roil_effect *e =
        collected ? roil_load_inside(r, j->inside, j->file, j->settings.all, j->settings.count)
                  : NULL;
    app_stats *stats = app_stats_create();
    int status = APP_DONE;
    if (!e) {
        status = app_fail_input();
    } else if (!render_complete(j, e)) {
        status = app_fail(APP_BAD_USAGE, "render: %s", roil_error());
    } else if (j->frames.count) {
        bool done = open_outputs(j, e) && render_frames(j, e, stats);
        if (!done) status = app_fail_input(); // before closing changes the message
        if (!close_outputs(j, done) && done) status = app_fail_input();
    }
    if (status == APP_DONE) {
        printf("%s on %s\n", j->file, roil_device_name(r));
        app_stats_print(stats);
        if (j->left_out) printf("%zu frames were there\n", j->left_out);
        for (size_t i = 0; j->frames.count && i < j->output_count; i++)
            printf("wrote %s\n", j->outputs[i].pattern);
        if (j->checkpoint && j->frames.count) printf("wrote %s\n", j->checkpoint);
        if (j->stats && !app_stats_save(stats, j->stats, r, j->file, j->width, j->height,
                                        j->settings.all, j->settings.count))
            status = app_fail_input();
    }
    app_stats_destroy(stats);
    roil_unload(e);
    return app_close(r, status);
}

int cmd_render(int argc, const char **argv) {
    job j = {.frames.step = 1, .shutter = 0.5};
    arena memory = {0};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, NULL, OPTION_OUTPUT,
         "PNG or EXR file or pattern, or a film (.mp4, .webm, .mov, .gif, .apng); may be given "
         "several times (default: "
         "out/NAME/%04d.png)",
         "FILE"},
        {"frames", 'f', POPT_ARG_STRING, NULL, APP_FRAMES,
         "30, or 10,30,50, or 1-100, or 1-100:2 (default: all)", "FRAMES"},
        {"warmup", '\0', POPT_ARG_INT, &j.warmup, 0,
         "draw N frames before each that does not follow the last, for passes with histories "
         "(default: 0)",
         "N"},
        {"size", 's', POPT_ARG_STRING, NULL, OPTION_SIZE, "size of the picture (default: 960x540)",
         "WxH"},
        {"set", '\0', POPT_ARG_STRING, NULL, APP_SET,
         "a parameter, or a uniform or option of a pass (march.steps=64)", "NAME=VALUE"},
        {"preset", '\0', POPT_ARG_STRING, NULL, APP_PRESET,
         "values saved beside the effect, or in a file; --set wins over them", "NAME|FILE.lua"},
        APP_EVENT_ROW,
        {"from", '\0', POPT_ARG_STRING, &j.from_file, 0,
         "use the effect, frame, size and settings of this picture where no others are given",
         "SHOT.png"},
        {"restore", '\0', POPT_ARG_STRING, &j.restore, 0,
         "continue the simulation from this file, by default with the frame after it; of a "
         "pattern, from the last before the frames",
         "FILE|PATTERN"},
        {"checkpoint", '\0', POPT_ARG_STRING, &j.checkpoint, 0,
         "write the state of the simulation after the last frame", "FILE|PATTERN"},
        {"checkpoint-every", '\0', POPT_ARG_INT, &j.checkpoint_every, 0,
         "write it after each N-th frame of the effect too", "N"},
        {"simulate-only", '\0', POPT_ARG_NONE, &j.simulates, 0,
         "draw no pictures: simulate the frames, for --checkpoint", NULL},
        {"shard", '\0', POPT_ARG_STRING, NULL, OPTION_SHARD,
         "only the I-th of N equal parts of the frames", "I/N"},
        {"skip-existing", '\0', POPT_ARG_NONE, &j.skips, 0,
         "leave out frames whose pictures are there, and whole", NULL},
        {"reference", '\0', POPT_ARG_STRING, NULL, OPTION_REFERENCE,
         "replace each pass march by a path tracer with so many samples per pixel", "SPP"},
        {"samples", '\0', POPT_ARG_STRING, NULL, OPTION_SAMPLES,
         "average N pictures of each frame, in linear light, for smooth edges, motion blur and a "
         "lens",
         "N"},
        {"shutter", '\0', POPT_ARG_DOUBLE, &j.shutter, 0,
         "frames that these are spread over, 0 to 1, from the frame on (default: 0.5, a shutter "
         "of 180 degrees)",
         "FRAMES"},
        {"stats", '\0', POPT_ARG_STRING, &j.stats, 0,
         "write GPU milliseconds by pass, samples taken, what is slow and the device as JSON",
         "FILE.json"},
        {"dump-pass", '\0', POPT_ARG_STRING, NULL, OPTION_DUMP,
         "also save an image of the graph: a pass, or march.edge", "NAME FILE"},
        {"fps", '\0', POPT_ARG_DOUBLE, &j.fps, 0,
         "frames per second of the video (default: the effect's)", "FPS"},
        {"alpha", '\0', POPT_ARG_NONE, &j.alpha, 0,
         "keep straight alpha in PNG files and films: bright light with little alpha is clipped at "
         "white",
         NULL},
        {"premultiplied", '\0', POPT_ARG_NONE, &j.premultiplied, 0,
         "keep alpha in PNG files, with colours as they appear on black: nothing is clipped", NULL},
        {"16", '\0', POPT_ARG_NONE, &j.sixteen, 0, "16 bits a channel in PNG files", NULL},
        {"float", '\0', POPT_ARG_NONE, &j.full, 0, "32-bit float in EXR files (default: half)",
         NULL},
        {"shown", '\0', POPT_ARG_NONE, &j.shown, 0,
         "EXR files of the tone-mapped picture with alpha, linear and premultiplied", NULL},
        app_device_rows(&j.device),
        POPT_AUTOHELP POPT_TABLEEND};
    argv = join_dump(&argc, argv, &memory);
    int status = app_run(argc, argv, "roil render", "EFFECT.lua [options]", options,
                         &(app_task){.job = &j,
                                     .check = render_check,
                                     .run = render_run,
                                     .take = take_option,
                                     .settings = &j.settings,
                                     .frames = &j.frames});
    mem_free(j.outputs);
    roil_free_recipe(j.from);
    arena_free(&memory);
    return status;
}
