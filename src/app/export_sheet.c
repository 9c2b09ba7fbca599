// roil export sheet EFFECT.lua -o fire.png: the frames of an effect as a flipbook, with the maps
// that engines want beside its colour.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct shot {   // what a cell is given
    double frame, part; // above 0: what it becomes, and how far it has
    uint32_t cell;
} shot;

typedef struct job {
    const char *file, *output, *frames_text, *grid;
    roil_sheet_desc desc;
    roil_sheet_options options;
    app_settings settings;
    app_device device;
    app_frames frames;
    int cell, gutter, camera, crop, all;
    uint32_t samples; // pictures that a cell is averaged of; 0: it is not
    double shutter;   // frames
    double loop;      // s
    bool whole;       // it repeats by itself
    shot *shots;      // by frame
    size_t shot_count, shot_capacity;
    char note[256];
    const char *notes[1];
    arena memory;
    const char *made[17]; // options that make it again
} job;

// ---- options ----------------------------------------------------------------------------------

static bool parse_grid(job *j) {
    char rest;
    if (!j->grid) {
        j->desc.columns = j->desc.rows = 8;
        return true;
    }
    return (sscanf(j->grid, "%2ux%2u%c", &j->desc.columns, &j->desc.rows, &rest) == 2 &&
            j->desc.columns > 0 && j->desc.rows > 0) ||
           err_set("--grid '%s'; accepted: COLUMNSxROWS, as 8x8, up to 64x64", j->grid);
}

static bool take_samples(void *user, int option, char *text) {
    (void)option; // the only one
    job *j = user;
    return app_parse_samples("--samples", text, &j->samples);
}

static bool sheet_check_options(void *user, poptContext arguments) {
    job *j = user;
    if (!app_take_effect(arguments, &j->file,
                         "which effect? usage: roil export sheet EFFECT.lua -o fire.png"))
        return false;
    if (!j->output) return err_set("-o is missing");
    if (strchr(j->output, '%'))
        return err_set("output '%s'; accepted: one file, as fire.png", j->output);
    const char *extension = path_extension(j->output);
    if (strcmp(extension, "png") != 0 && strcmp(extension, "exr") != 0 &&
        strcmp(extension, "tga") != 0)
        return err_set("output '%s'; accepted: .png, .exr, .tga", j->output);
    if (j->cell < 16 || j->cell > 4096)
        return err_set("--cell %d; accepted: 16 to 4096 pixels", j->cell);
    if (j->gutter < 0 || j->gutter > 1024)
        return err_set("--gutter %d; accepted: 0 to 1024 pixels", j->gutter);
    if (!(j->loop >= 0 && j->loop < 1e5))
        return err_set("--loop %g; accepted: seconds, above 0", j->loop);
    if (!app_check_shutter(j->shutter)) return false;
    if (j->options.page && strcmp(path_extension(j->options.page), "html") != 0)
        return err_set("--page '%s'; accepted: .html", j->options.page);
    j->desc.cell = (uint32_t)j->cell;
    j->desc.gutter = (uint32_t)j->gutter;
    j->desc.camera = j->camera;
    j->options.crop = j->crop;
    return parse_grid(j) && app_check_device(&j->device) &&
           (!j->frames_text || app_parse_frames(j->frames_text, &j->frames));
}

// Lists the options that say what is made, for the files to hold.
static void list_options(job *j) {
    const char *texts[][2] = {
        {"grid", j->grid},
        {"frames", j->frames_text},
        {"maps", j->desc.maps},
        {"for", j->options.engine},
        {"light", j->desc.light},
        {"alpha", j->options.alpha},
        {"format", j->options.format},
        {"source", j->desc.source},
    };
    size_t count = 0;
    for (size_t i = 0; i < COUNT_OF(texts); i++)
        if (texts[i][1])
            j->made[count++] = arena_format(&j->memory, "--%s=%s", texts[i][0], texts[i][1]);
    j->made[count++] = arena_format(&j->memory, "--cell=%d", j->cell);
    j->made[count++] = arena_format(&j->memory, "--gutter=%d", j->gutter);
    if (j->samples) {
        j->made[count++] = arena_format(&j->memory, "--samples=%u", j->samples);
        j->made[count++] = arena_format(&j->memory, "--shutter=%.17g", j->shutter);
    }
    if (j->loop > 0) j->made[count++] = arena_format(&j->memory, "--loop=%.17g", j->loop);
    if (j->crop) j->made[count++] = "--crop";
    if (j->camera) j->made[count++] = "--camera";
    if (j->all) j->made[count++] = "--all";
    j->options.made = j->made;
}

// ---- which frame goes where -------------------------------------------------------------------

static void add_shot(job *j, double frame, uint32_t cell, double part) {
    *MEM_ADD(j->shots, j->shot_count, j->shot_capacity) = (shot){frame, part, cell};
}

static int by_frame(const void *a, const void *b) {
    const shot *first = a, *second = b;
    return (first->frame > second->frame) - (first->frame < second->frame);
}

static bool plan_frames(job *j, const roil_effect_info *info) {
    const size_t cells = (size_t)j->desc.columns * j->desc.rows;
    double step = fmax((double)info->frames / (double)cells, 1);
    if (j->frames.count > cells)
        return err_set(
            "%zu frames in %zu cells; a larger --grid or a step (1-100:2) makes them fit",
            j->frames.count, cells);
    if (j->frames.count) {
        for (size_t i = 0; i < j->frames.count; i++)
            add_shot(j, j->frames.numbers[i], (uint32_t)i, 0);
        step = j->frames.step;
    } else {
        size_t count = info->frames < cells ? info->frames : cells;
        for (size_t i = 0; i < count; i++)
            add_shot(j, info->first_frame + step * (double)i, (uint32_t)i, 0);
    }
    j->options.count = (uint32_t)j->shot_count;
    j->options.fps = info->fps / step;
    app_warn_of_frames(&j->frames, info);
    return true;
}

static bool check_loop(const job *j, const roil_effect_info *info, double first, double last) {
    const double end = info->first_frame + info->frames;
    if (first >= info->first_frame - 1e-6 && last <= end + 1e-6) return true;
    return err_set("a loop of %g s%s does not fit into the effect's %g s%s", j->loop,
                   j->whole ? "" : " and the quarter of it before", info->frames / info->fps,
                   j->frames.count ? "; --frames says where it begins" : "");
}

// What repeats by itself is shown once. Of anything else the last quarter of the cells dissolves
// into what came before the first: both go on meanwhile, each along its own motion.
static bool plan_loop(job *j, roil_effect *e, const roil_effect_info *info) {
    char why[160];
    j->whole = roil_repeats(e, j->desc.source, j->loop, why, sizeof why);
    const uint32_t cells = j->desc.columns * j->desc.rows, fade = j->whole ? 0 : cells / 4;
    const double step = j->loop * info->fps / cells;
    const double first = j->frames.count ? j->frames.numbers[0] : info->first_frame + step * fade;
    if (cells < 4) return err_set("a loop of %u cells; at least 4", cells);
    if (!check_loop(j, info, first - step * fade, first + step * cells)) return false;
    for (uint32_t i = 0; i < cells; i++) {
        const double part = i < cells - fade ? 0 : (i - (cells - fade) + 1.0) / (fade + 1.0);
        const double before =
            part * part * (3 - 2 * part); // slow at both ends, of which one is the seam
        add_shot(j, first + step * i, i, 0);
        if (before > 0) add_shot(j, first + step * ((double)i - cells), i, before);
    }
    if (j->whole)
        snprintf(j->note, sizeof j->note, "loop: the medium repeats by itself after %g s", j->loop);
    else
        snprintf(j->note, sizeof j->note,
                 "loop: the last %u cells dissolve into what came before the first, since %s", fade,
                 why);
    j->desc.fade = fade;
    j->notes[0] = j->note;
    j->options.notes = j->notes;
    j->options.note_count = 1;
    j->options.count = cells;
    j->options.fps = info->fps / step;
    j->options.loop = j->loop;
    return true;
}

static bool plan(void *user, roil_effect *e) {
    job *j = user;
    roil_effect_info info = roil_get_info(e);
    if (!(j->loop > 0 ? plan_loop(j, e, &info) : plan_frames(j, &info))) return false;
    qsort(j->shots, j->shot_count, sizeof *j->shots, by_frame);
    j->desc.first = j->shots[0].frame;
    j->desc.last = j->shots[j->shot_count - 1].frame + (j->samples ? j->shutter : 0);
    return true;
}

// ---- work -------------------------------------------------------------------------------------

static bool draw(roil_effect *e, roil_sheet *s, uint32_t cell, const shot *shots, size_t count,
                 const char *unit) {
    app_progress progress, steps = {0};
    bool done = roil_prepare(e, cell, cell);
    roil_on_progress(e, app_tell_steps, &steps);
    app_progress_begin(&progress, count, unit);
    app_hear_interrupts();
    for (size_t i = 0; done && i < count; i++) {
        if (app_is_interrupted(NULL)) {
            done = err_set("stopped after %zu of %zu %s", i, count, unit);
            break;
        }
        const shot *now = &shots[i];
        done = roil_render(e, now->frame) &&
               (now->part > 0 ? roil_sheet_dissolve(s, now->cell, now->part)
                              : roil_sheet_add(s, now->cell, 1));
        if (done) app_progress_step(&progress, i + 1);
    }
    app_progress_end(&progress);
    return done;
}

// Finds where the medium is seen, in a few small frames.
static bool look(void *user, roil_effect *e) {
    enum { SIDE = 4, MOST = SIDE * SIDE, CELL = 64 };
    job *j = user;
    shot shots[MOST];
    size_t count = j->shot_count < MOST ? j->shot_count : MOST;
    for (size_t i = 0; i < count; i++) {
        size_t at = count > 1 ? i * (j->shot_count - 1) / (count - 1) : 0;
        shots[i] = (shot){j->shots[at].frame, 0, (uint32_t)i};
    }
    roil_sheet *s = roil_sheet_create(e, &(roil_sheet_desc){.source = j->desc.source,
                                                            .light = "both",
                                                            .columns = SIDE,
                                                            .rows = SIDE,
                                                            .cell = CELL,
                                                            .first = j->desc.first,
                                                            .last = j->desc.last});
    bool done = s && draw(e, s, CELL, shots, count, "looks");
    if (done) roil_sheet_find_used(s, (uint32_t)count, j->desc.part); // else all is shown
    roil_sheet_free(s);
    return done;
}

static bool export_all(void *user, roil_effect *e) {
    job *j = user;
    if (!app_can_write(j->output)) return false;
    list_options(j);
    if (j->samples && !roil_set_samples(e, j->samples, j->shutter)) return false;
    roil_sheet *s = roil_sheet_create(e, &j->desc);
    bool done = s && draw(e, s, j->desc.cell, j->shots, j->shot_count, "frames") &&
                roil_sheet_save(s, j->output, &j->options);
    if (done) {
        app_warn_of_trouble(e);
        printf("wrote %s: %u cells at %.4g a second\n", roil_sheet_summary(s), j->options.count,
               j->options.fps);
        if (j->note[0]) printf("%s\n", j->note);
    }
    roil_sheet_free(s);
    return done;
}

static int sheet_run(void *user) {
    job *j = user;
    return app_export_effect(&(app_export){.device = &j->device,
                                           .settings = &j->settings,
                                           .file = j->file,
                                           .plan = plan,
                                           .look = j->camera || j->all ? NULL : look,
                                           .make = export_all,
                                           .job = j});
}

int export_sheet(int argc, const char **argv) {
    job j = {.frames.step = 1, .cell = 256, .gutter = 4, .shutter = 0.5};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &j.output, 0,
         "the colours; maps are beside them (fire-motion.png), and what is in them (fire.json)",
         "FILE.png|.exr|.tga"},
        {"grid", 'g', POPT_ARG_STRING, &j.grid, 0, "cells across and down (default: 8x8)",
         "COLUMNSxROWS"},
        {"cell", '\0', POPT_ARG_INT, &j.cell, 0, "pixels along each side of a cell (default: 256)",
         "N"},
        {"gutter", '\0', POPT_ARG_INT, &j.gutter, 0,
         "pixels at the edges of a cell that stay empty, so that neighbours do not mix in mip "
         "levels (default: "
         "4, good for three levels)",
         "N"},
        {"frames", 'f', POPT_ARG_STRING, &j.frames_text, 0,
         "30, or 1-100, or 1-100:2 (default: all, evenly spread over the cells)", "FRAMES"},
        {"loop", '\0', POPT_ARG_DOUBLE, &j.loop, 0,
         "let it repeat after so long: the last quarter dissolves into what was before the first "
         "cell",
         "SECONDS"},
        {"maps", '\0', POPT_ARG_STRING, &j.desc.maps, 0,
         "color, motion, six-way, normal, depth, temperature, separated by commas (default: color)",
         "NAMES"},
        {"for", '\0', POPT_ARG_STRING, &j.options.engine, 0,
         "signs and encodings of an engine: unity, unreal, godot or labs", "ENGINE"},
        {"light", '\0', POPT_ARG_STRING, &j.desc.light, 0,
         "of the colours: shown, tone-mapped; scene, before that; or both (default: shown)",
         "WORD"},
        {"alpha", '\0', POPT_ARG_STRING, &j.options.alpha, 0,
         "premultiplied, straight or both (default: premultiplied, or as the engine has it)",
         "WORD"},
        {"format", '\0', POPT_ARG_STRING, &j.options.format, 0,
         "png, png16 (16 bits a channel), exr or tga (default: by the name)", "WORD"},
        {"crop", '\0', POPT_ARG_NONE, &j.crop, 0, "cut the cells to what is used in any", NULL},
        {"camera", '\0', POPT_ARG_NONE, &j.camera, 0,
         "keep the effect's camera (default: orthographic, looking the same way, around all that "
         "is "
         "seen)",
         NULL},
        {"all", '\0', POPT_ARG_NONE, &j.all, 0,
         "show all places where the medium may be, without a look at where it is, which takes up "
         "to "
         "16 small frames, and simulates twice",
         NULL},
        {"source", '\0', POPT_ARG_STRING, &j.desc.source, 0, "a pass march (default: the first)",
         "NAME"},
        {"samples", '\0', POPT_ARG_STRING, NULL, 1, "as in roil render", "N"},
        {"shutter", '\0', POPT_ARG_DOUBLE, &j.shutter, 0,
         "as in roil render, in frames of the effect", "FRAMES"},
        {"page", '\0', POPT_ARG_STRING, &j.options.page, 0,
         "a page for a browser that plays the sheet, lights it and shows its maps", "FILE.html"},
        {"set", '\0', POPT_ARG_STRING, NULL, APP_SET, "as in roil render", "NAME=VALUE"},
        {"preset", '\0', POPT_ARG_STRING, NULL, APP_PRESET, "as in roil render", "NAME|FILE.lua"},
        app_device_rows(&j.device),
        POPT_AUTOHELP POPT_TABLEEND};
    int status =
        app_run(argc, argv, "roil export sheet", "EFFECT.lua -o fire.png [options]", options,
                &(app_task){.job = &j,
                            .check = sheet_check_options,
                            .run = sheet_run,
                            .take = take_samples,
                            .settings = &j.settings,
                            .frames = &j.frames});
    mem_free(j.shots);
    arena_free(&j.memory);
    return status;
}
