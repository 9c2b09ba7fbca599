// The options of commands that open a device: which, and how.
#pragma once
#include "roil.h"
#include <popt.h>

// The row for commands that let others open it. `to`: of a const char *.
#define APP_DEVICE_ROW(to)                                                                         \
    { "device", 'd', POPT_ARG_STRING, (to), 0, "part of a device's name, or its number", "DEVICE" }

typedef struct app_device {
    const char *name;
    double timeout; // seconds; 0: as roil_desc says
    int validate, no_cache;
    struct poptOption rows[5];
} app_device;

// The row of an option table that includes all of them; `d` must stay where it is.
struct poptOption app_device_rows(app_device *d);
bool app_check_device(const app_device *d);
roil_desc app_device_desc(const app_device *d);
