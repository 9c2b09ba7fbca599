// A field on a plane of 3 x 3 m, sampled as wide as asked.
#include "lib/grid.glsl"
//@ field float value : what is shown
#include "fields.glsl"
uniform float width; //= 0 [0, 1e6] m : of a sample
writeonly uniform image2D color; //= output rgba16f : the field

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 at = (vec2(pixel) + 0.5) / vec2(size);
    grid_width = width;
    imageStore(color, pixel, vec4(field_value(vec3(3.0 * at, 0.4))));
}
