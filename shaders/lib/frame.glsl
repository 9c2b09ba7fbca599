// The block "Frame" (shared.h) and the camera's rays.
#include "shared.h"
layout(std140, binding = 0) uniform Frame { frame_block frame; };

// Direction through a point of the picture (0..1, y down), not normalised: one metre deep.
vec3 frame_ray(vec2 uv) {
    vec2 screen = (vec2(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y) - frame.shift.xy) * frame.lens.xy;
    return (frame.view_inverse * vec4(screen, -1.0, 0.0)).xyz;
}

// Where a point of the camera's space, `deep` metres before it, is in the picture (0..1, y down).
vec2 frame_seen(vec2 at, float deep) {
    vec2 screen = at / (deep * frame.lens.xy) + frame.shift.xy;
    return 0.5 + 0.5 * vec2(screen.x, -screen.y);
}

// Tangents of the angles to the sides of what the camera sees, from what lies straight ahead: of the farther one.
vec2 frame_across() { return frame.lens.xy * (1.0 + abs(frame.shift.xy)); }

// The same where the camera is not moved by a part of a pixel.
vec3 frame_ray_still(vec2 uv) {
    return frame_ray(uv) - (frame.view_inverse * vec4(frame.sight.xy, 0.0, 0.0)).xyz;
}
