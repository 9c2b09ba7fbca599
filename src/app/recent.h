// Effects that were open in the window before, with pictures of them, in the user's state folder.
#pragma once
#include "base/file.h"
#include "roil.h"

enum { RECENT_MOST = 12 };
size_t recent_list(char (*out)[PATH_CAP]); // at most RECENT_MOST, the last first; those that exist
// Notes an effect that was shown, with its last picture.
void recent_add(const char *file, roil_effect *e);
// Finds a picture of an effect: of the last time, or one beside it in gallery/small/. False: there
// is none.
bool recent_picture(const char *file, char out[PATH_CAP]);
