// The page that `roil live` shows when no effect is named: effects to choose from, and new ones.
#pragma once
#include "app/device_options.h"
#include "app/opening.h"

// Runs it in a window of its own until the user has chosen. Returns APP_DONE; `out` has no file
// when the window was closed. Otherwise an exit status, when a message was printed.
int start_choose(const app_device *device, int width, int height, opening *out);
