// The lowest layer of a window: its background, and the effect's picture in its place.
#include "view/encode.glsl"
layout(std140) uniform View {
    vec4 background; // sRGB
    ivec4 place;     // of the picture: left, top, width, height in pixels
};
uniform sampler2D picture; // display-referred, linear
uniform sampler2D noise;   // value v of 8 bits stands for (v + 0.5) / 256; goes on without end
layout(rgba8) writeonly uniform image2D canvas;

vec3 shown(ivec2 at) {
    // At its own size not even rounding may change it.
    if (place.zw == textureSize(picture, 0)) return texelFetch(picture, at, 0).rgb;
    return textureLod(picture, (vec2(at) + 0.5) / vec2(place.zw), 0.0).rgb;
}

// Between two codes noise decides, as in PNG files of 8 bits (roil_picture.c): dark skies would have
// bands. It stands still, or they would boil.
vec3 dithered(vec3 linear, ivec2 at) {
    vec3 texel = texelFetch(noise, at % textureSize(noise, 0), 0).rgb;
    return floor(encode(linear) * 255.0 + (texel * 255.0 + 0.5) / 256.0) / 255.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(canvas)))) return;
    ivec2 at = pixel - place.xy;
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, place.zw));
    imageStore(canvas, pixel, vec4(inside ? dithered(shown(at), at) : background.rgb, 1.0));
}
