// Meter: one number, whatever the size of the picture.
#include "pass/builtin.h"
#include "pass/pass_impl.h"

bool meter_declare(pass *p) {
    int output = pass_find_image(p, "exposure");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.exposure", p->label),
                            .format = p->formats[output],
                            .width = 1,
                            .height = 1,
                        });
    return p->images[output].id && pass_declare_images(p) && pass_add_to_graph(p);
}
