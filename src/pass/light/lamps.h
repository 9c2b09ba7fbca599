// The pass type `point_lights`: lamps by the hundred, from fields that the device evaluates once
// for each (shaders/pass/light/lamps.comp), as an image with a row of four texels for each.
//
// A pass that reads it has `#include "lib/lamps.glsl"`, which declares an input `lamps`: given by
// name or by `from`, it orders the passes. Before such a pass runs, its picture is divided into
// tiles, and which lamps may light something in each is found out
// (shaders/pass/light/lamps_lists.comp). All that comes by itself, in a user's shader too, by
// pass_lamps_provider.
//
// An option `lamps_by` of the reader says how: auto, all (every lamp for every pixel), tiles, and
// volumes where the reader draws them itself (lamps_volumes.c).
#pragma once
#include "pass/pass.h"

enum { PASS_LAMPS_MOST = 16384 }; // rows of an image on any device

// Before pass_declare: so many lamps, or (`at`, which may be NULL) one for each of the instances.
// False with a message.
bool pass_lamps_open(pass *p, uint32_t count, scene_instances *at);

// ---- for passes that read them ----------------------------------------------------------------

typedef struct pass_lamps pass_lamps; // of a pass that reads them
typedef enum lamps_way { LAMPS_ALL, LAMPS_TILES, LAMPS_VOLUMES } lamps_way;

uint32_t pass_lamps_count(const pass *p); // that it reads; 0: it reads none
lamps_way pass_lamps_way(const pass *p);
