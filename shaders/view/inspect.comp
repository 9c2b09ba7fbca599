// An image of the graph as a person looks into it: one level, of a volume one slice; each texel a
// crisp square when it is enlarged, a mean of some when it is made smaller.
//
// VOLUME: the image is 3D. WHOLE: its texels are whole numbers.
#include "view/encode.glsl"
layout(std140) uniform View {
    vec4 center_zoom;   // xy: centre of the view, 0 to 1; z: pixels for one texel; w: factor of exposure
    ivec4 slice;        // x: direction of sight (0 x, 1 y, 2 z); y: which slice; z: channels; w: show the sign
    ivec4 cursor;       // xy: pixel whose value is wanted
};
#if WHOLE && VOLUME
uniform usampler3D image;
#elif WHOLE
uniform usampler2D image;
#elif VOLUME
uniform sampler3D image;
#else
uniform sampler2D image;
#endif
layout(rgba8) writeonly uniform image2D canvas;
layout(rgba32f) writeonly uniform image2D texel; // value under the cursor; then where it is, and 1 when it is

const int MAX_TAPS = 4; // of each side of a pixel
const vec3 FIELD = vec3(0.055), MAGENTA = vec3(1.0, 0.0, 1.0); // sRGB
const float DARK = 0.13, LIGHT = 0.3; // checkers behind what is transparent, linear
const int CHECKER = 8;                // pixels

// Volumes are seen with +z, or along z +y, upwards.
#if VOLUME
ivec2 plane_size() {
    ivec3 size = textureSize(image, 0);
    return slice.x == 0 ? size.yz : slice.x == 1 ? size.xz : size.xy;
}

ivec3 place(ivec2 at) {
    ivec2 up = ivec2(at.x, plane_size().y - 1 - at.y);
    return slice.x == 0 ? ivec3(slice.y, up) : slice.x == 1 ? ivec3(up.x, slice.y, up.y) : ivec3(up, slice.y);
}
#else
ivec2 plane_size() { return textureSize(image, 0); }
ivec3 place(ivec2 at) { return ivec3(at, 0); }
#endif

vec4 fetch(ivec2 at) {
#if VOLUME
    return vec4(texelFetch(image, place(at), 0));
#else
    return vec4(texelFetch(image, at, 0));
#endif
}

bool is_inside(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, plane_size()));
}

bool has(int bit) { return (slice.z & bit) != 0; }

// Asked bit by bit: compilers may assume that numbers are finite.
bool is_broken(vec4 c) {
    uvec4 exponents = floatBitsToUint(c) & 0x7f800000u;
    return any(bvec4(has(1) && exponents.r == 0x7f800000u, has(2) && exponents.g == 0x7f800000u,
                     has(4) && exponents.b == 0x7f800000u, has(8) && exponents.a == 0x7f800000u));
}

float larger(float a, float b) { return abs(b) > abs(a) ? b : a; }

// Of the chosen channels the one that is farthest from zero.
vec3 signed_color(vec4 c) {
    c *= vec4(has(1), has(2), has(4), has(8));
    float value = larger(larger(c.r, c.g), larger(c.b, c.a));
    return encode(abs(value) * (value > 0.0 ? vec3(1.0, 0.35, 0.05) : vec3(0.05, 0.35, 1.0)));
}

vec3 plain_color(vec4 c, ivec2 pixel) {
    if (bitCount(slice.z) == 1)
        return encode(vec3(has(1) ? c.r : has(2) ? c.g : has(4) ? c.b : c.a));
    vec3 chosen = c.rgb * vec3(has(1), has(2), has(4));
    if (!has(8)) return encode(chosen);
    ivec2 square = pixel / CHECKER;
    float behind = ((square.x + square.y) & 1) == 0 ? DARK : LIGHT;
    return encode(chosen + behind * (1.0 - clamp(c.a, 0.0, 1.0)));
}

// The mean over what a pixel covers. True when anything there is infinite or no number.
bool gather(vec2 center, out vec4 mean, out bool any_inside) {
    float covered = 1.0 / center_zoom.z;
    int taps = clamp(int(ceil(covered - 0.001)), 1, MAX_TAPS);
    float count = 0.0;
    bool broken = false;
    mean = vec4(0.0);
    for (int y = 0; y < taps; y++)
        for (int x = 0; x < taps; x++) {
            vec2 offset = taps == 1 ? vec2(0.0) : ((vec2(x, y) + 0.5) / float(taps) - 0.5) * covered;
            ivec2 at = ivec2(floor(center + offset));
            if (!is_inside(at)) continue;
            vec4 c = fetch(at);
            broken = broken || is_broken(c);
            mean += c;
            count += 1.0;
        }
    any_inside = count > 0.0;
    mean /= max(count, 1.0);
    return broken;
}

void tell(ivec2 at) {
    bool inside = is_inside(at);
    imageStore(texel, ivec2(0), inside ? fetch(at) : vec4(0.0));
    imageStore(texel, ivec2(1, 0), inside ? vec4(place(at), 1.0) : vec4(0.0));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(canvas);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 center = center_zoom.xy * vec2(plane_size()) + (vec2(pixel) + 0.5 - 0.5 * vec2(size)) / center_zoom.z;
    if (pixel == cursor.xy) tell(ivec2(floor(center)));
    vec4 value;
    bool inside, broken = gather(center, value, inside);
    value.rgb *= center_zoom.w;
    if (bitCount(slice.z) == 1 || slice.w != 0) value.a *= center_zoom.w;
    vec3 color = broken ? MAGENTA : slice.w != 0 ? signed_color(value) : plain_color(value, pixel);
    imageStore(canvas, pixel, vec4(inside ? color : FIELD, 1.0));
}
