// Pictures from files as images of the graph. The host has the numbers: nothing is dispatched.
#include "pass/picture.h"
#include "base/maths.h"
#include "base/memory.h"
#include "media/picture.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <math.h>

void pass_picture_open(pass *p, const struct picture *from) {
    p->state = (void *)(uintptr_t)from; // is only read
}

bool picture_declare(pass *p) {
    const picture *from = p->state;
    int output = pass_find_image(p, "color");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.color", p->label),
                            .format = p->formats[output],
                            .width = from->width,
                            .height = from->height,
                            .keep = true,
                        });
    return p->images[output].id && pass_add_to_graph(p);
}

bool picture_check(pass *p) {
    (void)p;
    return true;
}

bool picture_build(pass *p) {
    (void)p;
    return true;
}

static float linear(float v) { // IEC 61966-2-1
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static void convert(const picture *from, uint16_t *out) {
    size_t count = (size_t)4 * from->width * from->height;
    for (size_t i = 0; i < count; i++) {
        bool encoded = from->bits > 0 && i % 4 < 3;
        out[i] =
            half_from_float(clampf(encoded ? linear(from->rgba[i]) : from->rgba[i], -65504, 65504));
    }
}

bool picture_record(pass *p) {
    const picture *from = p->state;
    graph_image output = p->images[pass_find_image(p, "color")];
    if (graph_has_content(p->host->graph, output)) return true;
    size_t size = (size_t)8 * from->width * from->height;
    uint16_t *halves = mem_alloc(size);
    convert(from, halves);
    bool done =
        gpu_image_write(p->host->device, graph_get_image(p->host->graph, output), 0, halves, size);
    mem_free(halves);
    return done;
}
