// The pass type `point_lights`: point lights by the hundred, from fields that the device evaluates
// once for each (shaders/pass/light/point_lights.comp), as an image with a row of four texels for
// each.
//
// A pass that reads it has `#include "lib/point_lights.glsl"`, which declares an input
// `point_lights`: given by name or by `from`, it orders the passes. Before such a pass runs, its
// picture is divided into tiles, and which point lights may light something in each is found out
// (shaders/pass/light/point_lights_lists.comp). All that comes by itself, in a user's shader too,
// by pass_point_lights_provider.
//
// An option `point_lights_by` of the reader says how: auto, all (every point light for every
// pixel), tiles, and volumes where the reader draws them itself (point_lights_lists.c).
#pragma once
#include "pass/pass.h"

enum { PASS_POINT_LIGHTS_MOST = 16384 }; // rows of an image on any device

// Before pass_declare: so many point lights, or (`at`, which may be NULL) one for each of the
// instances. False with a message.
bool pass_point_lights_open(pass *p, uint32_t count, scene_instances *at);

// ---- for passes that read them ----------------------------------------------------------------

typedef struct pass_point_lights pass_point_lights; // of a pass that reads them
typedef enum point_lights_way {
    POINT_LIGHTS_ALL,
    POINT_LIGHTS_TILES,
    POINT_LIGHTS_VOLUMES
} point_lights_way;
