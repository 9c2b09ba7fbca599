// Bake: a field evaluated at every voxel centre of a box, once a frame, into a grid that other
// fields sample. effect/ makes the grid and sets size and box.
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"

void pass_set_bake(pass *p, const field_grid *grid) {
    p->baked = grid;
}

bool bake_declare(pass *p) {
    const field_grid *grid = p->baked;
    int output = pass_find_image(p, "values");
    p->images[output] = graph_add_image(p->host->graph, &(graph_image_desc){
                                                            .name = p->label,
                                                            .format = GPU_RGBA16F,
                                                            .width = grid->size[0],
                                                            .height = grid->size[1],
                                                            .depth = grid->size[2],
                                                        });
    if (!p->images[output].id) return false;
    pass_host_add_grid_image(p->host, grid, p->images[output]);
    return pass_add_to_graph(p);
}

bool bake_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const field_grid *grid = p->baked;
    pass_write_member(binary, block, "box_min", &grid->box.min, sizeof grid->box.min);
    pass_write_member(binary, block, "box_max", &grid->box.max, sizeof grid->box.max);
    return true;
}
