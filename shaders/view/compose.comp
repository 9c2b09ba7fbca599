// The lowest layer of a window: its background, and the effect's picture in its place.
#include "lib/random.glsl"
#include "view/encode.glsl"
layout(std140) uniform View {
    vec4 background; // sRGB
    ivec4 place;     // of the picture: left, top, width, height in pixels
};
uniform sampler2D picture; // display-referred, linear
layout(rgba8) writeonly uniform image2D canvas;

vec3 shown(ivec2 at) {
    // At its own size not even rounding may change it.
    if (place.zw == textureSize(picture, 0)) return texelFetch(picture, at, 0).rgb;
    return textureLod(picture, (vec2(at) + 0.5) / vec2(place.zw), 0.0).rgb;
}

// Between two codes blue noise decides, as in PNG files of 8 bits (roil_picture.c): dark skies would
// have bands. It stands still, or they would boil.
vec3 dithered(vec3 linear, uvec2 at) {
    const uint apart = 64u / 3u; // channels do not err together
    vec3 noise = vec3(random_blue(at, 0u), random_blue(at + uvec2(apart, 0u), 0u),
                      random_blue(at + uvec2(2u * apart, 0u), 0u));
    return floor(encode(linear) * 255.0 + noise) / 255.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(canvas)))) return;
    ivec2 at = pixel - place.xy;
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, place.zw));
    imageStore(canvas, pixel, vec4(inside ? dithered(shown(at), uvec2(at)) : background.rgb, 1.0));
}
