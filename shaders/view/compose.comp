// The lowest layer of a window: its background, and the effect's picture in its place.
#include "view/encode.glsl"
layout(std140) uniform View {
    vec4 background; // sRGB
    ivec4 place;     // of the picture: left, top, width, height in pixels
    ivec4 beside;    // of another one ...
    ivec4 split;     // ... that is shown from this pixel on, counted from the left
};
uniform sampler2D picture; // display-referred, linear
uniform sampler2D other;   // the same
uniform sampler2D noise;   // value v of 8 bits stands for (v + 0.5) / 256; goes on without end
layout(rgba8) writeonly uniform image2D canvas;

// At its own size not even rounding may change it.
vec3 shown(ivec2 at) {
    if (place.zw == textureSize(picture, 0)) return texelFetch(picture, at, 0).rgb;
    return textureLod(picture, (vec2(at) + 0.5) / vec2(place.zw), 0.0).rgb;
}

vec3 shown_beside(ivec2 at) {
    if (beside.zw == textureSize(other, 0)) return texelFetch(other, at, 0).rgb;
    return textureLod(other, (vec2(at) + 0.5) / vec2(beside.zw), 0.0).rgb;
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
    bool right = pixel.x >= split.x;
    ivec4 area = right ? beside : place;
    ivec2 at = pixel - area.xy;
    vec3 color = background.rgb;
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, area.zw)))
        color = dithered(right ? shown_beside(at) : shown(at), at);
    imageStore(canvas, pixel, vec4(color, 1.0));
}
