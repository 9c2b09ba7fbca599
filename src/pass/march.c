// March: the box that rays are cut to is computed on the host, from the bounds of the density.
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

static const field *density_of(const pass *p) {
    size_t index;
    return pass_find_key(p, "density", &index) == PASS_FIELD ? p->fields[index] : NULL;
}

static bool bounded(const pass *p, box3 *box) {
    if (!field_bounds(density_of(p), p->host->context, box)) return err_prefix("%s: ", p->label);
    if (box3_is_finite(*box) || box3_is_empty(*box)) return true;
    return err_set("%s: field 'density' fills all of space; multiply it by a grid or a shape",
                   p->label);
}

bool march_declare(pass *p) {
    box3 box;
    return bounded(p, &box) && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool paper_mode(const pass *p) {
    size_t index;
    if (pass_find_key(p, "mode", &index) != PASS_OPTION) return false;
    return strcmp(p->face->options[index].words[p->options[index]], "paper") == 0;
}

// The paper marches the whole simulation box in every frame (section 3.5); otherwise the box is as
// tight as what burns just now.
static bool march_box(const pass *p, box3 *box) {
    const field *density = density_of(p);
    const field_grid *grids[16];
    size_t count = field_grids(density, grids, 16);
    if (paper_mode(p) && count) {
        *box = box3_empty();
        for (size_t i = 0; i < count && i < 16; i++) *box = box3_union(*box, grids[i]->box);
        return true;
    }
    return bounded(p, box);
}

bool march_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    box3 box;
    if (!march_box(p, &box)) return false;
    if (box3_is_empty(box)) box = (box3){{0, 0, 0}, {0, 0, 0}};
    pass_write_member(binary, block, "box_min", &box.min, sizeof box.min);
    pass_write_member(binary, block, "box_max", &box.max, sizeof box.max);
    return true;
}
