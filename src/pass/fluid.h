// Fields that what flows is asked for by name, as `lbm` and `slices` have them: channels of a grid.
#pragma once
#include <stdbool.h>

enum {
    PASS_FLUID_DENSITY,
    PASS_FLUID_TEMPERATURE,
    PASS_FLUID_DYE,
    PASS_FLUID_PRESSURE,
    PASS_FLUID_VELOCITY,
    PASS_FLUID_NAMES, // of these
    PASS_FLUID_CHANNELS = 8,
};
extern const char *const pass_fluid_names[PASS_FLUID_NAMES];

// Notes in `used` that a field of that name is wanted. Its first channel; -1 with a message that
// begins with `label`.
int pass_fluid_use(const char *label, bool used[PASS_FLUID_NAMES], const char *name,
                   int *components);
