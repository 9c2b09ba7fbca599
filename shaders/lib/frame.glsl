// The block "Frame" (shared.h) and the camera's rays.
#include "shared.h"
layout(std140, binding = 0) uniform Frame { frame_block frame; };

// Direction through a point of the picture (0..1, y down), not normalised: one metre deep.
vec3 frame_ray(vec2 uv) {
    vec2 screen = vec2(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y) * frame.lens.xy;
    return (frame.view_inverse * vec4(screen, -1.0, 0.0)).xyz;
}
