// Pictures of templates in the folders of an effect and of the library; for src/roil*.c only.
#pragma once
#include "media/picture.h"
#include "roil_impl.h"

// Where a new one of that name will lie; false with a message when it is no name, or taken.
bool template_new_path(const roil_effect *e, const char *name, char out[PATH_CAP]);
// The flow of the list, which has that slice; NULL with a message.
pass *roil_slices_find(const roil_effect *e, size_t flow, uint32_t slice);
// The same, of a square that something can be put into.
pass *roil_slices_find_square(const roil_effect *e, const roil_slices_square *where);
