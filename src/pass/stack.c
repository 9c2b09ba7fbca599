// Stack: what it draws into has a size of its own; the box of its slices is the density's.
#include "base/memory.h"
#include "pass/pass_impl.h"

static bool add_image(pass *p, const char *output, uint32_t side) {
    int image = pass_find_image(p, output);
    p->images[image] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, output),
                            .format = p->formats[image],
                            .width = side,
                            .height = side,
                        });
    return p->images[image].id != 0;
}

static bool declare(pass *p) {
    uint32_t side = pass_number(p, "target");
    if (!pass_check_density(p)) return false;
    if (side && (!add_image(p, "color", side) || !add_image(p, "edge", side))) return false;
    return pass_declare_images(p) && pass_add_to_graph(p);
}

static bool update(pass *p) {
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_set_box(p, box);
    return true;
}

const pass_type stack_type = {
    .name = "stack",
    .shader = "pass/stack.comp",
    .declare = declare,
    .update = update,
};
