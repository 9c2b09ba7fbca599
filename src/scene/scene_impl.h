// Help for the files of this layer only.
#pragma once
#include "scene/scene.h"

// Evaluates a field that does not vary in space; of one component: all four are that.
bool scene_evaluate(const field *node, const field_context *context, float out[4]);
bool scene_evaluate_scalar(const field *node, const field_context *context, float *out);
// What a product of parameters makes of a number is kept within what it can be; of no number:
// `low`.
float scene_limit(float value, float low, float high);
float scene_limit_light(float value); // of a colour times a factor
// Unit vector from angles in degrees: about +Z from +X, and above the horizon.
void scene_direction(float azimuth, float elevation, vec3 out);
// What stands at a place to the world, through all that it stands in.
bool scene_place_matrix(const field *position, const field *rotation, const field *scale,
                        const scene_node *parent, const field_context *context, mat4 out);
