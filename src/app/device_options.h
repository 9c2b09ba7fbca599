// The options of commands that open a device: which, and how.
#pragma once
#include "roil.h"
#include <popt.h>

// The row for commands that let others open it. `to`: of a const char *.
#define APP_DEVICE_ROW(to)                                                                         \
    { "device", 'd', POPT_ARG_STRING, (to), 0, "part of a device's name, or its number", "DEVICE" }

// The row for how long a load may take. `to`: of a double.
#define APP_TIME_ROW(to)                                                                           \
    {                                                                                              \
        "time-limit", '\0', POPT_ARG_DOUBLE, (to), 0,                                              \
            "that loading an effect may take; the script of a frame gets a tenth (default: 120)",  \
            "SECONDS"                                                                              \
    }

typedef struct app_device {
    const char *name;
    double timeout, time_limit; // seconds; 0: as roil_desc says
    int validate, no_cache;
    const char *memory; // NULL: as roil_desc says
    struct poptOption rows[7];
} app_device;

// The row for commands that open none, too. `to`: of a const char *.
#define APP_MEMORY_ROW(to)                                                                         \
    {                                                                                              \
        "memory", '\0', POPT_ARG_STRING, (to), 0,                                                  \
            "that may be taken of the machine and of the device (default: 60%)", "SHARE%|AMOUNT"   \
    }

// The row of an option table that includes all of them; `d` must stay where it is.
struct poptOption app_device_rows(app_device *d);
bool app_check_device(const app_device *d);
roil_desc app_device_desc(const app_device *d);
