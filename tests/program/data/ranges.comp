// Boxes of random places and sizes, one a pixel: red where a value of the density at one of many
// points inside lies outside of its range there; green where the range says that there is nothing,
// blue where the points find nothing.
//@ option sampling = linear {linear, quasi_cubic, cubic} : of grids
//@ field float density : whose ranges are tried
uniform vec3 low;                  //= {-10, -10, -10} m : of all boxes
uniform vec3 high;                 //= {20, 20, 20} m : of all boxes
uniform float largest;             //= 0.25 [0, 1] : of a box, as a part of all
uniform float width;               //= 0 [0, 10] m : of samples
writeonly uniform image2D color;   //= output rgba16f : what was found
#define WITH_RANGES
#include "fields.glsl"

uint state;
float next() {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8) / 16777216.0;
}

void main() {
    grid_width = range_width = width;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    state = uint(pixel.x + 4096 * pixel.y) * 2654435761u;
    vec3 whole = high - low, corner = low + vec3(next(), next(), next()) * whole;
    vec3 side = whole * largest * pow(next(), 3.0) * vec3(next(), next(), next());
    vec2 range = field_density_range(corner, corner + side);
    bool outside = false;
    float most = 0.0;
    for (int i = 0; i < 32; i++) {
        vec3 part = clamp(vec3(next(), next(), next()) * 1.5 - 0.25, 0.0, 1.0);
        float v = field_density(corner + part * side), slack = 1e-5 * max(abs(v), 1e-3);
        outside = outside || v < range.x - slack || v > range.y + slack;
        most = max(most, v);
    }
    imageStore(color, pixel, vec4(outside, range.y <= 0.0, most <= 0.0, 1.0));
}
