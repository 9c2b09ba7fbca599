// The program begins anew: after a device that hangs, which cannot be freed, and after a crash of
// the driver. It has then what the user had set, and holds the effect back.
#pragma once
#include "app/device_options.h"
#include "app/live.h"

// Does not return when it can be done; else an exit status.
int restart(const live *l, const app_device *device);

// From now on a fault of the process restarts it, with what is set now; to be called again when
// that has changed. A program that holds its effect back is not restarted, so that one that cannot
// run ends.
void restart_arm(const live *l);
void restart_disarm(void);
