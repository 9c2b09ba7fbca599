// Fields that what flows is asked for by name: channels of the grid that its pass fills.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct pass_fluid_field {
    const char *name;
    int channel, components; // the first channel
} pass_fluid_field;

// Of `lbm` and `slices`.
enum {
    PASS_FLUID_DENSITY,
    PASS_FLUID_TEMPERATURE,
    PASS_FLUID_DYE,
    PASS_FLUID_PRESSURE,
    PASS_FLUID_VELOCITY,
    PASS_FLUID_NAMES, // of these
    PASS_FLUID_CHANNELS = 8,
    PASS_FLUID_MOST_NAMES = 12, // of any table
};
extern const pass_fluid_field pass_fluid_fields[PASS_FLUID_NAMES];

// Notes in `used` that a field of that name is wanted. Its first channel; -1 with a message that
// begins with `label`.
int pass_fluid_use(const char *label, const pass_fluid_field *fields, size_t count, bool *used,
                   const char *name, int *components);
// The field of the table that is nearest to `name`; NULL: none is near.
const char *pass_fluid_nearest(const pass_fluid_field *fields, size_t count, const char *name);
