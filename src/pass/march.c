// March: the box that rays are cut to is computed on the host, from the bounds of the density.
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

bool march_declare(pass *p) {
    box3 box;
    return pass_density_box(p, &box) && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool paper_mode(const pass *p) {
    size_t index;
    if (pass_find_key(p, "mode", &index) != PASS_OPTION) return false;
    return strcmp(p->face->options[index].words[p->options[index]], "paper") == 0;
}

// The paper marches the whole simulation box in every frame (section 3.5); otherwise the box is as
// tight as what burns just now.
static bool march_box(const pass *p, box3 *box) {
    const field *density = pass_density(p);
    const field_grid *grids[16];
    size_t count = field_grids(density, grids, 16);
    if (paper_mode(p) && count) {
        *box = box3_empty();
        for (size_t i = 0; i < count && i < 16; i++) *box = box3_union(*box, grids[i]->box);
        return true;
    }
    return pass_density_box(p, box);
}

bool march_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    box3 box;
    if (!march_box(p, &box)) return false;
    pass_write_box(binary, block, box);
    return true;
}
