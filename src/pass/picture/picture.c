// Pictures from files as images of the graph. The host has the numbers: nothing is dispatched.
#include "pass/picture/picture.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/srgb.h"
#include "media/picture.h"
#include "pass/pass_impl.h"
#include <math.h>

enum { N_color };
static const char *const names[] = {"color"};
static const pass_kernel kernels[1]; // it runs none

void pass_picture_open(pass *p, const struct picture *from) {
    p->state = (void *)(uintptr_t)from; // is only read
}

static bool picture_declare(pass *p) {
    const picture *from = p->state;
    return pass_add_output(
               p, N_color,
               (graph_image_desc){.width = from->width, .height = from->height, .keep = true}) &&
           pass_add_to_graph(p);
}

static void convert(const picture *from, uint16_t *out) {
    size_t count = (size_t)4 * from->width * from->height;
    for (size_t i = 0; i < count; i++) {
        bool encoded = from->bits > 0 && i % 4 < 3;
        out[i] = half_from_float(
            clampf(encoded ? linear_from_srgb(from->rgba[i]) : from->rgba[i], -65504, 65504));
    }
}

static bool picture_record(pass *p) {
    const picture *from = p->state;
    if (graph_has_content(p->host->graph, *pass_image(p, N_color))) return true;
    size_t size = (size_t)8 * from->width * from->height;
    uint16_t *halves = mem_alloc(size);
    convert(from, halves);
    bool done = gpu_image_write(p->host->device, pass_get_image(p, N_color), 0, halves, size);
    mem_free(halves);
    return done;
}

const pass_type picture_type = {
    .name = "picture",
    .constructed = true,
    .shader = "pass/picture/picture.comp",
    .kernels = kernels,
    .kernel_count = 0,
    .names = {names, COUNT_OF(names)},
    .unscaled = true,
    .declare = picture_declare,
    .record = picture_record,
};
