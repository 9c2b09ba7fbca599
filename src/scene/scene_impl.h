// Helper functions for the files of this layer only.
#pragma once
#include "scene/scene.h"

// Evaluates a field that does not vary in space. A single component is copied to all four.
bool scene_evaluate(const field *node, const field_context *context, float out[4]);
bool scene_evaluate_scalar(const field *node, const field_context *context, float *out);
// Clamps a number, which a product of parameters may have made invalid. NaN becomes `low`.
float scene_limit(float value, float low, float high);
float scene_limit_light(float value); // clamps a colour times a factor
// Returns the transform to the world, through all parents.
bool scene_place_matrix(const field *position, const field *rotation, const field *scale,
                        const scene_node *parent, const field_context *context, mat4 out);
