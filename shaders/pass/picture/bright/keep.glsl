// What of a colour is bright, by `threshold`, `knee`, `limit` and `intensity` in the mode MODE of the pass bright.
#include "lib/color.glsl"

vec3 bright_keep(vec3 c, bool paper) {
    float l = luminance(c);
    if (paper) return l > threshold ? intensity * c : vec3(0.0);
    float width = max(threshold * knee, 1e-4);
    float soft = clamp(l - threshold + width, 0.0, 2.0 * width);
    float over = max(l - threshold, soft * soft / (4.0 * width));
    return c * (intensity * min(over, limit) / max(l, 1e-4));
}
