// Ranges of grids: textures of the least and the greatest values over bricks, for fields that are
// asked for their range (field/program_range.c). The device computes them where a shader reads
// them, when the grid's content has changed; a grid whose ranges nobody asks for costs nothing.
#pragma once
#include "pass/pass_impl.h"

// After compiling: makes what is needed if `binary` reads ranges. Any thread.
bool pass_ranges_build(pass *p, const shader_binary *binary);
// Returns the texture for an image of a grid as it is now, and records what brings it up to date.
// NULL with a message.
gpu_image *pass_ranges_get(pass *p, const field_texture *texture);
// Adds the textures that its kernels read and that are not there. One for a kernel that is built in
// a later frame (pass_make_late) is made in that frame.
void pass_ranges_list_memory(const pass *p, budget_list *out);
void pass_ranges_free(pass_host *host);
extern const kernel_table ranges_kernel_table;
