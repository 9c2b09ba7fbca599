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
