// A camera that the user moves: it turns around a point, pans and zooms. Z is up. Needs no window.
#pragma once
#include "roil.h"
#include <stdbool.h>

typedef struct orbit {
    float target[3];    // metres
    float distance;     // from the eye to the target (m)
    float yaw, pitch;   // degrees, as of orbit { } in Lua
    float fov;          // vertical, degrees
    float orthographic; // height of what it sees (m); 0: perspective, by `fov`
} orbit;

void orbit_from(orbit *o, const roil_camera *camera);
void orbit_to(const orbit *o, roil_camera *out);
void orbit_turn(orbit *o, float dx, float dy); // degrees; pitch stays within 89 of the horizon
void orbit_pan(orbit *o, float dx, float dy);  // relative to the picture's height
// Changes to no perspective, or back to it: what is at the target keeps its size.
void orbit_flatten(orbit *o);
void orbit_deepen(orbit *o);
float orbit_height(const orbit *o);     // of what is seen at the target (m)
void orbit_zoom(orbit *o, float steps); // steps of the wheel; positive is nearer
// Raises the eye to at least a height (m), by turning the camera up, or by moving it up if `shift`
// says so or turning is not enough.
void orbit_raise(orbit *o, float height, bool shift);
// Makes a box fill a picture of the aspect ratio `aspect` (width over height).
void orbit_frame(orbit *o, const float low[3], const float high[3], float aspect);
