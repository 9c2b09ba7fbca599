// What of an effect stands somewhere in space, and which control is behind a field that says where.
#pragma once
#include "effect/effect.h"

typedef struct effect_shape { // a field of the group "shape", whose arguments say where it is
    const char *name;         // of its controls: the variable, or the kind
    const field *node;
} effect_shape;
size_t effect_shapes(const effect *e, const effect_shape **out);
size_t effect_nodes(const effect *e, scene_node *const **out);
size_t effect_meshes(const effect *e, scene_mesh *const **out);
size_t effect_grids(const effect *e, field_grid *const **out);

// Returns the control that changes what a field gives: of numbers that the script wrote there or a
// setting gave, of a parameter, of a curve. NULL: it is computed, by an expression or a function.
const effect_control *effect_control_behind(const effect *e, const field *node);
// Returns the control "GROUP.NAME"; NULL without a message.
const effect_control *effect_control_named(effect *e, const char *group, const char *name);

typedef struct effect_reading { // what a script reads of a grid
    const char *name;           // "air.density"
    const field *node;
} effect_reading;
enum { EFFECT_MAX_READINGS = 32, EFFECT_PROBE_VALUES = 8 }; // later ones are left out
void effect_note_reading(effect *e, const field_grid *grid, const char *name, const field *node);

typedef struct effect_probed { // at a point; probe.c
    bool found;                // there is something
    float at[3];               // metres
    float density;             // of all media (1/m)
    struct {
        const char *name; // effect_reading.name
        int components;
        float value[4];
    } values[EFFECT_PROBE_VALUES];
    size_t count;
} effect_probed;
// Finds what one sees of the media through a point of the picture (0..1 from the top left), by the
// last frame. Waits for the device. False with a message.
bool effect_probe(effect *e, float x, float y, effect_probed *out);
