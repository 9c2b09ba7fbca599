// roil compare A B: measures the difference of two pictures, and checks it against limits.
#include "app/app.h"
#include "app/device_options.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/str.h"
#include <jansson.h>
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <string.h>

typedef struct compare_job {
    roil_comparison how;
    const char *json, *memory;
    double max_flip, min_psnr; // 1 and -INFINITY: no limit
} compare_job;

static void print_difference(const roil_difference *d) {
    printf("%ux%u pixels\n", d->width, d->height);
    printf("PSNR %10.3f dB\n", d->psnr);
    printf("SSIM %10.5f\n", d->ssim);
    printf("FLIP %10.5f\n", d->flip);
}

// JSON has no infinity: the PSNR of equal pictures is null there.
static bool save_difference(const compare_job *job, const roil_difference *d) {
    json_t *psnr = isfinite(d->psnr) ? json_real(d->psnr) : json_null();
    json_t *root = json_pack("{s:s, s:s, s:s, s:i, s:i, s:o, s:f, s:f}", "roil", roil_version(),
                             "a", job->how.a, "b", job->how.b, "width", (int)d->width, "height",
                             (int)d->height, "psnr", psnr, "ssim", d->ssim, "flip", d->flip);
    char *text = root ? json_text(root, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(root);
    if (!text) return err_set("%s: the figures cannot be written as JSON", job->json);
    bool done = file_make_parent_folders(job->json) && file_write(job->json, text, strlen(text));
    mem_free(text);
    return done;
}

// Prints one message with every limit that is exceeded.
static int check_limits(const compare_job *job, const roil_difference *d) {
    strbuf why = {0};
    if (d->flip > job->max_flip)
        strbuf_add(&why, ": FLIP %.5f, at most %g is accepted", d->flip, job->max_flip);
    if (d->psnr < job->min_psnr)
        strbuf_add(&why, "%s PSNR %.3f dB, at least %g is accepted", why.length ? ";" : ":",
                   d->psnr, job->min_psnr);
    int status = APP_DONE;
    if (why.length)
        status = app_fail(APP_DIFFERS, "%s differs from %s%s", job->how.b, job->how.a,
                          strbuf_text(&why));
    strbuf_free(&why);
    return status;
}

static int compare_pictures(void *user) {
    compare_job *job = user;
    roil_difference d;
    if (!roil_compare(&job->how, &d)) return app_fail_input();
    print_difference(&d);
    if (job->json && !save_difference(job, &d)) return app_fail_input();
    return check_limits(job, &d);
}

static bool usage(const char *message) {
    return err_set("%s; usage: roil compare A B [-o DIFFERENCE.png]", message);
}

static bool compare_check(void *user, poptContext arguments) {
    compare_job *job = user;
    job->how.a = poptGetArg(arguments);
    job->how.b = poptGetArg(arguments);
    if (!job->how.b || poptPeekArg(arguments)) return usage("two pictures are compared");
    if (!(job->max_flip >= 0 && job->max_flip <= 1)) return usage("--max-flip is 0 to 1");
    if (isnan(job->min_psnr)) return usage("--min-psnr is a number of dB");
    return !job->memory || budget_set_share(job->memory) || err_prefix("--");
}

int cmd_compare(int argc, const char **argv) {
    compare_job job = {.max_flip = 1, .min_psnr = -INFINITY};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &job.how.difference, 0,
         "picture of FLIP: black where both look the same", "DIFFERENCE.png"},
        {"beside", 0, POPT_ARG_STRING, &job.how.beside, 0, "A, B and that picture side by side",
         "FILE.png"},
        {"json", 0, POPT_ARG_STRING, &job.json, 0, "write the figures to a file", "FILE"},
        {"max-flip", 0, POPT_ARG_DOUBLE, &job.max_flip, 0,
         "end with status 3 when FLIP is above (0 to 1)", "X"},
        {"min-psnr", 0, POPT_ARG_DOUBLE, &job.min_psnr, 0,
         "end with status 3 when PSNR is below (dB)", "X"},
        {"exposure", 0, POPT_ARG_FLOAT, &job.how.exposure, 0,
         "stops by which EXR pictures are brightened; then they are clamped to 0 to 1 and "
         "sRGB-encoded, for all three figures",
         "EV"},
        {"ppd", 0, POPT_ARG_DOUBLE, &job.how.pixels_per_degree, 0,
         "pixels per degree of the observer's sight, for FLIP (default: 67)", "X"},
        APP_MEMORY_ROW(&job.memory),
        POPT_AUTOHELP POPT_TABLEEND};
    return app_run(argc, argv, "roil compare", "A.png|A.exr B.png|B.exr", options,
                   &(app_task){.job = &job, .check = compare_check, .run = compare_pictures});
}
