// Restarts the program: after the device hangs, which cannot be freed, and after a crash of the
// driver. The new process has the user's settings, and does not draw the effect until it is told
// to.
#pragma once
#include "app/device_options.h"
#include "app/live.h"

// Restarts the program now. Returns an exit status only when that fails.
int restart(const live *l, const app_device *device);

// From now on a fault of the process restarts it with the settings of now. Call it again when they
// have changed. A process that is not drawing after a restart is not restarted again, so that a
// program that cannot run ends.
void restart_arm(const live *l);
void restart_disarm(void);
