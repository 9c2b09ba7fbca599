// Templates as files in the folders of an effect and of the library. For src/roil*.c only.
#pragma once
#include "roil/roil_impl.h"

// Returns the path of a new template. False with a message when `name` is not valid or exists.
bool template_new_path(const roil_effect *e, const char *name, char out[PATH_CAP]);
// Returns flow number `flow` of roil_slices_list. NULL with a message when it has no such slice.
pass *roil_slices_find(const roil_effect *e, size_t flow, uint32_t slice);
// The same for a square; NULL with a message also when the square is not finite or has no side.
pass *roil_slices_find_square(const roil_effect *e, const roil_slices_square *where);
