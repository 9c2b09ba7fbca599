// Meter: one number, whatever the size of the picture.
#include "base/memory.h"
#include "pass/pass_impl.h"

enum { N_exposure };
static const char *const names[] = {"exposure"};

static bool meter_declare(pass *p) {
    return pass_add_output(p, N_exposure, (graph_image_desc){.width = 1, .height = 1}) &&
           pass_declare_images(p) && pass_add_to_graph(p);
}

const pass_type meter_type = {
    .name = "meter",
    .shader = "pass/picture/meter.comp",
    .names = {names, COUNT_OF(names)},
    .declare = meter_declare,
};
