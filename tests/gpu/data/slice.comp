// A slice of a field across the Y axis, as a user's own pass may show it.
//@ field float value : what is shown
//@ field vec3 tint after value = {1, 1, 1} : its colour
uniform float half_width;          //= 1 [0.01, 100] m : of the slice
uniform float y;                   //= 0 m : where it lies
writeonly uniform image2D color;   //= output rgba16f : the slice
#include "fields.glsl"
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 p = vec3((2.0 * uv.x - 1.0) * half_width, y, (1.0 - 2.0 * uv.y) * half_width);
    float value = field_value(p);
    imageStore(color, pixel, value == 0.0 ? vec4(0.0) : vec4(value * field_tint(p), value));
}
