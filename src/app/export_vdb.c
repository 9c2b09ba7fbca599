// roil export vdb EFFECT.lua -o DIR/%04d.vdb: what fills space in an effect, frame by frame.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct job {
    const char *file, *output;
    roil_volume_desc volume;
    app_settings settings;
    app_device device;
    app_frames frames;
    double tolerance;
} job;

enum { OPTION_SIZE = 1, OPTION_BOX };

// ---- options ----------------------------------------------------------------------------------

static bool parse_size(const char *text, uint32_t *out) {
    char *end;
    long size = strtol(text, &end, 10);
    if (end == text || *end || size < 1 || size > 1024)
        return err_set("--size '%s'; accepted: 1 to 1024 voxels along the longest side", text);
    *out = (uint32_t)size;
    return true;
}

static bool parse_box(const char *text, float out[2][3]) {
    float *v = out[0];
    char rest;
    if (sscanf(text, "%f,%f,%f,%f,%f,%f%c", v, v + 1, v + 2, v + 3, v + 4, v + 5, &rest) == 6 &&
        v[0] < v[3] && v[1] < v[4] && v[2] < v[5])
        return true;
    return err_set("--box '%s'; accepted: X,Y,Z,X,Y,Z, the least and the greatest corner", text);
}

static bool take_option(void *user, int option, char *text) {
    job *j = user;
    return option == OPTION_SIZE ? parse_size(text, &j->volume.size)
                                 : parse_box(text, j->volume.box);
}

static bool export_check_options(void *user, poptContext arguments) {
    job *j = user;
    if (!app_take_effect(arguments, &j->file,
                         "which effect? usage: roil export vdb EFFECT.lua -o DIR/%04d.vdb"))
        return false;
    if (!j->output) return err_set("-o is missing");
    if (!str_ends_with(j->output, ".vdb")) return err_set("output '%s'; accepted: .vdb", j->output);
    if (!(j->tolerance >= 0 && j->tolerance < 1e6))
        return err_set("--tolerance %g; accepted: 0 or more", j->tolerance);
    j->volume.tolerance = (float)j->tolerance;
    return app_check_pattern(j->output) && app_check_device(&j->device);
}

// ---- work -------------------------------------------------------------------------------------

enum { PICTURE = 16 }; // pixels a side of what is not drawn

static bool export_complete(void *user, roil_effect *e) {
    job *j = user;
    roil_effect_info info = roil_get_info(e);
    char range[64];
    snprintf(range, sizeof range, "%u-%u", info.first_frame, info.first_frame + info.frames - 1);
    if (!j->frames.count && !app_parse_frames(range, &j->frames)) return false;
    if (j->frames.count > 1 && !app_has_number(j->output))
        return err_set("output '%s' would be overwritten by each of %zu frames; name it like "
                       "%%04d.vdb",
                       j->output, j->frames.count);
    app_warn_of_frames(&j->frames, &info);
    j->volume.first = j->frames.numbers[0];
    j->volume.last = j->frames.numbers[j->frames.count - 1];
    j->volume.alone = true;
    return true;
}

static bool write_frames(const job *j, roil_effect *e, roil_volume *v) {
    app_progress progress, steps = {0};
    bool done = roil_prepare(e, PICTURE, PICTURE);
    roil_on_progress(e, app_tell_steps, &steps);
    app_progress_begin(&progress, j->frames.count, "frames");
    app_hear_interrupts();
    for (size_t i = 0; done && i < j->frames.count; i++) {
        char file[PATH_CAP];
        if (app_is_interrupted(NULL)) {
            done = err_set("stopped after %zu of %zu frames", i, j->frames.count);
            break;
        }
        app_format_pattern(j->output, j->frames.numbers[i], file, sizeof file);
        done = roil_render(e, j->frames.numbers[i]) && roil_volume_save(v, file);
        if (done) app_progress_step(&progress, i + 1);
    }
    app_progress_end(&progress);
    return done;
}

static bool export_all(void *user, roil_effect *e) {
    job *j = user;
    char file[PATH_CAP];
    app_format_pattern(j->output, j->frames.numbers[0], file, sizeof file);
    if (!app_can_write(file)) return false;
    roil_volume *v = roil_volume_create(e, &j->volume);
    if (!v) return false;
    roil_volume_info info = roil_volume_get_info(v);
    bool done = write_frames(j, e, v) || (roil_volume_finish(v), false);
    if (!done || !roil_volume_finish(v)) return false;
    app_warn_of_trouble(e);
    printf("wrote %s: %zu frames of %s, %u x %u x %u voxels of %g m\n", j->output, j->frames.count,
           info.fields, info.size[0], info.size[1], info.size[2], (double)info.voxel_size);
    return true;
}

static int export_run(void *user) {
    job *j = user;
    return app_export_effect(&(app_export){.device = &j->device,
                                           .settings = &j->settings,
                                           .file = j->file,
                                           .plan = export_complete,
                                           .make = export_all,
                                           .job = j});
}

int export_vdb(int argc, const char **argv) {
    job j = {.frames.step = 1};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &j.output, 0, "file or pattern", "DIR/%04d.vdb"},
        {"frames", 'f', POPT_ARG_STRING, NULL, APP_FRAMES,
         "30, or 1-100, or 1-100:2 (default: all)", "FRAMES"},
        {"source", '\0', POPT_ARG_STRING, &j.volume.source, 0,
         "a grid by the name of its variable, or a pass whose medium it is (default: the grid that "
         "is simulated, else the medium of the march)",
         "NAME"},
        {"fields", '\0', POPT_ARG_STRING, &j.volume.fields, 0,
         "fields of the source, separated by commas (default: all)", "NAMES"},
        {"size", '\0', POPT_ARG_STRING, NULL, OPTION_SIZE,
         "voxels along the longest side (default: those of the source)", "N"},
        {"box", '\0', POPT_ARG_STRING, NULL, OPTION_BOX,
         "corners in metres (default: the box that is not empty in these frames)", "X,Y,Z,X,Y,Z"},
        {"tolerance", '\0', POPT_ARG_DOUBLE, &j.tolerance, 0,
         "values up to this are not stored (default: 0)", "VALUE"},
        {"set", '\0', POPT_ARG_STRING, NULL, APP_SET, "as in roil render", "NAME=VALUE"},
        {"preset", '\0', POPT_ARG_STRING, NULL, APP_PRESET, "as in roil render", "NAME|FILE.lua"},
        app_device_rows(&j.device),
        POPT_AUTOHELP POPT_TABLEEND};
    return app_run(argc, argv, "roil export vdb", "EFFECT.lua -o DIR/%04d.vdb [options]", options,
                   &(app_task){.job = &j,
                               .check = export_check_options,
                               .run = export_run,
                               .take = take_option,
                               .settings = &j.settings,
                               .frames = &j.frames});
}
