// The options of commands that open a device.
#pragma once
#include "roil.h"
#include <popt.h>

// The row of commands in which others open the device. `to`: address of a const char *.
#define APP_DEVICE_ROW(to)                                                                         \
    {                                                                                              \
        "device", 'd', POPT_ARG_STRING, (to), 0,                                                   \
            "part of a device's name, its UUID or its number", "DEVICE"                            \
    }

// The row for how long a load may take. `to`: address of a double.
#define APP_TIME_ROW(to)                                                                           \
    {                                                                                              \
        "time-limit", '\0', POPT_ARG_DOUBLE, (to), 0,                                              \
            "limit on loading an effect; the script of a frame gets a tenth (default: 120)",       \
            "SECONDS"                                                                              \
    }

// The row of commands whose results programs read too. `to`: address of an int.
#define APP_JSON_ROW(to)                                                                           \
    { "json", '\0', POPT_ARG_NONE, (to), 0, "print JSON, for programs", NULL }

// The row of commands that load effects. `to`: address of a const char **, NULL at first.
#define APP_ASSETS_ROW(to)                                                                         \
    {                                                                                              \
        "assets", '\0', POPT_ARG_ARGV, (to), 0,                                                    \
            "a folder that effects may read besides their own; may be given several times", "DIR"  \
    }

typedef struct app_device {
    const char *name;
    double timeout, time_limit; // seconds; 0: the default of roil_desc
    int validate, no_cache;
    const char *memory; // NULL: the default of roil_desc
    const char **assets;
    struct poptOption rows[8];
} app_device;

// The row of commands with or without a device. `to`: address of a const char *.
#define APP_MEMORY_ROW(to)                                                                         \
    {                                                                                              \
        "memory", '\0', POPT_ARG_STRING, (to), 0,                                                  \
            "limit on the memory of the machine and of the device (default: 60%)", "SHARE%|AMOUNT" \
    }

// Returns the row of an option table that includes all of these. `d` must not move.
struct poptOption app_device_rows(app_device *d);
bool app_check_device(const app_device *d);
roil_desc app_device_desc(const app_device *d);
