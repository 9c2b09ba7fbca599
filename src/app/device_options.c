#include "app/device_options.h"
#include "base/budget.h"
#include "base/error.h"
#include <assert.h>
#include <string.h>

struct poptOption app_device_rows(app_device *d) {
    const struct poptOption rows[] = {
        APP_DEVICE_ROW(&d->name),
        {"timeout", '\0', POPT_ARG_DOUBLE, &d->timeout, 0,
         "time limit of a frame, after which the device counts as lost (default: 30, software 300)",
         "SECONDS"},
        APP_ASSETS_ROW(&d->assets),
        APP_MEMORY_ROW(&d->memory),
        APP_TIME_ROW(&d->time_limit),
        {"validate", '\0', POPT_ARG_NONE, &d->validate, 0, "enable the Vulkan validation layers",
         NULL},
        {"no-cache", '\0', POPT_ARG_NONE, &d->no_cache, 0,
         "do not read or write compiled shaders on disk", NULL},
        POPT_TABLEEND};
    static_assert(sizeof rows == sizeof d->rows, "app_device has a place for each row");
    memcpy(d->rows, rows, sizeof rows);
    return (struct poptOption){.argInfo = POPT_ARG_INCLUDE_TABLE, .arg = d->rows};
}

bool app_check_device(const app_device *d) {
    if (d->memory && !budget_set_share(d->memory)) return err_prefix("--");
    if (!(d->time_limit >= 0))
        return err_set("--time-limit %g; accepted: 0 or more", d->time_limit);
    return d->timeout >= 0 || err_set("--timeout %g; accepted: 0 or more", d->timeout);
}

roil_desc app_device_desc(const app_device *d) {
    return (roil_desc){.device = d->name,
                       .validate = d->validate,
                       .no_cache = d->no_cache,
                       .timeout = d->timeout,
                       .memory = d->memory,
                       .assets = d->assets,
                       .time_limit = d->time_limit};
}
