// OpenEXR by the reader: the data of its jobs and of their results.
#include "base/error.h"
#include "base/str.h"
#include "media/exr.h"
#include <string.h>

enum { CHANNELS_MAX = 64, CHANNEL_NAME = 256 };

typedef struct task { // the job's argument
    picture_limits limits;
    char letters[8]; // "": all
} task;

typedef struct head { // of the result; then `count` times sent_channel and its plane
    uint32_t width, height, count;
} head;

typedef struct sent_channel {
    uint32_t half;
    char name[CHANNEL_NAME];
} sent_channel;

bool exr_work(const isolate_call *call) {
    task t;
    arena memory = {0};
    exr_image image;
    if (!picture_take_argument(call, &t, sizeof t)) return false;
    const exr_wish wish = {t.letters[0] ? t.letters : NULL, t.limits};
    if (!exr_decode(call->bytes, call->size, call->name, &wish, &memory, &image)) return false;
    const head h = {image.width, image.height, (uint32_t)image.channel_count};
    bool done = isolate_put(call, &h, sizeof h);
    for (size_t c = 0; done && c < image.channel_count; c++) {
        sent_channel sent = {.half = image.channels[c].half};
        str_copy(sent.name, sizeof sent.name, image.channels[c].name);
        done = isolate_put(call, &sent, sizeof sent) &&
               isolate_put(call, image.channels[c].values,
                           (size_t)image.width * image.height * sizeof(float));
    }
    arena_free(&memory);
    return done;
}

bool exr_size_work(const isolate_call *call) {
    picture_limits limits;
    exr_image image;
    if (!picture_take_argument(call, &limits, sizeof limits)) return false;
    const exr_wish wish = {"RGB", limits};
    return exr_decode(call->bytes, call->size, call->name, &wish, NULL, &image) &&
           picture_put_size(call, image.width, image.height);
}

static bool take_channels(const head *h, const char *sent, arena *memory, exr_image *out) {
    size_t bytes = (size_t)h->width * h->height * sizeof(float);
    exr_channel *channels = arena_alloc(memory, h->count * sizeof *channels);
    for (uint32_t c = 0; c < h->count; c++) {
        sent_channel channel;
        memcpy(&channel, sent, sizeof channel);
        channel.name[sizeof channel.name - 1] = '\0';
        sent += sizeof channel;
        channels[c] = (exr_channel){arena_string(memory, channel.name),
                                    arena_copy(memory, sent, bytes), channel.half != 0};
        sent += bytes;
    }
    *out = (exr_image){h->width, h->height, channels, h->count};
    return true;
}

static bool take_image(const char *path, const picture_limits *limits, const isolate_result *r,
                       arena *memory, exr_image *out) {
    head h = {0};
    if (r->size >= sizeof h) memcpy(&h, r->data, sizeof h);
    size_t pixel = sizeof(float) * (h.count ? h.count : 1), count = (size_t)h.width * h.height;
    if (h.count > CHANNELS_MAX || !picture_limits_allow(limits, path, h.width, h.height, pixel) ||
        r->size != sizeof h + h.count * (sizeof(sent_channel) + count * sizeof(float)))
        return err_set("%s: damaged: its reader returned nonsense", path);
    return take_channels(&h, (const char *)r->data + sizeof h, memory, out);
}

bool exr_read(const char *path, const exr_wish *wish, arena *memory, exr_image *out) {
    return exr_read_inside(NULL, path, wish, memory, out);
}

bool exr_read_inside(const char *root, const char *path, const exr_wish *wish, arena *memory,
                     exr_image *out) {
    isolate_result result;
    task t = {.limits = wish ? wish->limits : picture_limits_default};
    if (wish && wish->letters) str_copy(t.letters, sizeof t.letters, wish->letters);
    const isolate_job job = {.kind = "exr", .arguments = &t, .argument_size = sizeof t};
    *out = (exr_image){0};
    if (!picture_run_job(root, path, &t.limits, job, &result)) return false;
    bool done = take_image(path, &t.limits, &result, memory, out);
    isolate_free(&result);
    return done;
}
