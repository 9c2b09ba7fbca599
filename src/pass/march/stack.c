// Stack: what it draws into has a size of its own; the box of its slices is the density's.
#include "base/memory.h"
#include "pass/pass_impl.h"

#define NAMES(NAME) NAME(target), NAME(color), NAME(edge)
KERNEL_NAMES(NAMES);

static bool stack_declare(pass *p) {
    const uint32_t side = pass_option_number(p, N_target); // 0: as the pass's scale says
    const graph_image_desc size = {.width = side, .height = side};
    if (!pass_check_density(p)) return false;
    if (side && !(pass_add_output(p, N_color, size) && pass_add_output(p, N_edge, size)))
        return false;
    return pass_declare_images(p) && pass_add_to_graph(p);
}

static bool stack_update(pass *p) {
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_set_box(p, box);
    return true;
}

const pass_type stack_type = {
    .name = "stack",
    .shader = "pass/march/stack.comp",
    .names = {names, COUNT_OF(names)},
    .declare = stack_declare,
    .update = stack_update,
};
