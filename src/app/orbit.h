// A camera moved by hand: turned about a point, shifted, brought near. Z is up. Knows no window.
#pragma once
#include "roil.h"
#include <stdbool.h>

typedef struct orbit {
    float target[3];  // metres
    float distance;   // of the eye from it
    float yaw, pitch; // degrees, as of orbit { } in Lua
    float fov;        // vertical, degrees
} orbit;

void orbit_from(orbit *o, const roil_camera *camera);
void orbit_to(const orbit *o, roil_camera *out);
void orbit_turn(orbit *o, float dx, float dy); // degrees; pitch stays within 89 of the horizon
void orbit_pan(orbit *o, float dx, float dy);  // shares of the picture's height
void orbit_zoom(orbit *o, float steps);        // of the wheel; positive is nearer
// So that the eye is at least that high (m): turned up, or, if `shift` says so or turning does not
// reach, shifted up.
void orbit_raise(orbit *o, float height, bool shift);
// So that a box fills the picture of that width over height.
void orbit_frame(orbit *o, const float low[3], const float high[3], float aspect);
