#include "media/limits.h"
#include "base/error.h"

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
