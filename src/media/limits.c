#include "media/limits.h"
#include "base/error.h"
#include "base/file.h"
#include <string.h>
#include <unistd.h>

const picture_limits picture_limits_default = {16384, 16384, (uint64_t)1 << 30};

static double mebibytes(uint64_t bytes) {
    return (double)bytes / (1 << 20);
}

bool picture_limits_allow(const picture_limits *limits, const char *name, int64_t width,
                          int64_t height, size_t pixel_bytes) {
    if (width < 1 || height < 1 || width > limits->width || height > limits->height)
        return err_set("%s: a picture of %lldx%lld; up to %ux%u is accepted", name,
                       (long long)width, (long long)height, limits->width, limits->height);
    uint64_t bytes = (uint64_t)width * (uint64_t)height * pixel_bytes; // below 2^60
    if (bytes <= limits->bytes) return true;
    return err_set(
        "%s: a picture of %lldx%lld with %zu bytes a pixel takes %.0f MiB; up to %.0f MiB "
        "are accepted",
        name, (long long)width, (long long)height, pixel_bytes, mebibytes(bytes),
        mebibytes(limits->bytes));
}

isolate_limits picture_limits_of_job(const picture_limits *limits, size_t size) {
    const uint64_t beside = (uint64_t)1 << 30; // what the libraries need to work in
    return (isolate_limits){.processor_ms = 60000,
                            .memory = size + limits->bytes + beside,
                            .result = limits->bytes + (1 << 20)};
}

bool picture_run_job(const char *root, const char *path, const picture_limits *limits,
                     isolate_job job, isolate_result *out) {
    static const size_t most = (size_t)4 << 30;
    *out = (isolate_result){0};
    job.name = path;
    job.file = file_open_inside(root, path, most, &job.size);
    if (job.file < 0) return false;
    job.limits = picture_limits_of_job(limits, job.size);
    bool done = isolate_run(&job, out);
    close(job.file);
    return done;
}

bool picture_take_argument(const isolate_call *call, void *out, size_t size) {
    if (call->argument_size != size) return err_set("%s: no limits", call->name);
    memcpy(out, call->arguments, size);
    return true;
}

bool picture_put_size(const isolate_call *call, uint32_t width, uint32_t height) {
    const picture_size size = {width, height};
    return isolate_put(call, &size, sizeof size);
}

bool picture_read_size(const char *path, const char *kind, picture_size *out) {
    const picture_limits *limits = &picture_limits_default;
    isolate_result r;
    if (!picture_run_job(
            NULL, path, limits,
            (isolate_job){.kind = kind, .arguments = limits, .argument_size = sizeof *limits}, &r))
        return false;
    *out = (picture_size){0};
    if (r.size == sizeof *out) memcpy(out, r.data, sizeof *out);
    isolate_free(&r);
    return picture_limits_allow(limits, path, out->width, out->height, 1);
}
