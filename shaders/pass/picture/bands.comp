// Bands instead of shades: flat colours with sharp edges, as in a drawing, for what was marched or
// splatted. bands { volume, color = ramp(position.x) } draws a fireball as if it was painted with `levels`
// colours; over { drawn, picture } lays it over a picture.
//
// What is banded is how bright the light is, or how much it hides. Below `low` nothing is drawn, so that
// this is the outline; from `high` on all is the last band. Each band has the value of its middle (as
// toon shading has it), for which `color` is asked at position.x.
//@ option of = light {light, opacity} : what is banded: light: the luminance of what shines; opacity: how much is hidden, as of smoke
//@ field vec3 color = {1, 1, 1} : of a band; at position.x: the middle of the band, 0..1, position.y: low to high in as many steps as there are bands, 0..1
//@ field float opacity = 1 : of a band, asked in the same way
uniform sampler2D source;        //= input : premultiplied radiance and opacity, as of march or splats
uniform int levels;              //= 4 [1, 64] : bands
uniform float low;               //= 0.05 [0, 65000] : where the first band begins
uniform float high;              //= 1 [0, 65000] : where the last one ends
uniform float curve;             //= 1 [0.05, 20] : above 1: lower bands are wider; below: higher ones
uniform float soften;            //= 1 [0, 16] pixels : over which one band goes over to the next
uniform float keep_hue;          //= 0 [0, 1] : part of the source's own hue that is kept
writeonly uniform image2D image; //= output rgba16f : premultiplied colour and opacity
#include "lib/frame.glsl"
#include "lib/color.glsl"
#include "fields.glsl"

// In bands: 0 where the first begins, `levels` where the last ends.
float bands_at(vec4 c) {
#if OF == OF_LIGHT
    float value = luminance(c.rgb);
#else
    float value = c.a;
#endif
    float share = (value - low) / max(high - low, 1e-6);
    return float(levels) * (share > 0.0 ? pow(share, 1.0 / curve) : share);
}

// A source of fewer pixels is smooth between them, and its bands as sharp as those of a large one.
float bands_near(vec2 uv) { return bands_at(textureLod(source, uv, 0.0)); }

// Integral of floor(x), for its mean over an interval: an edge that is as wide as that.
float floor_sum(float x) {
    float whole = floor(x);
    return whole * (x - 0.5 * (whole + 1.0));
}

float floor_mean(float x, float width) {
    float whole = floor(x), rest = x - whole; // small numbers are exact
    if (width < 1e-3) return whole;
    return whole + (floor_sum(rest + 0.5 * width) - floor_sum(rest - 0.5 * width)) / width;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size), next = 1.0 / vec2(size);
    vec4 here = textureLod(source, uv, 0.0);
    float t = bands_at(here);
    vec2 slope = 0.5 * vec2(bands_near(uv + vec2(next.x, 0.0)) - bands_near(uv - vec2(next.x, 0.0)),
                            bands_near(uv + vec2(0.0, next.y)) - bands_near(uv - vec2(0.0, next.y)));
    float width = min(soften * length(slope), float(levels));
    float band = clamp(floor_mean(t, width), 0.0, float(levels) - 1.0);
    float cover = width < 1e-3 ? step(0.0, t) : clamp(t / width + 0.5, 0.0, 1.0);
    vec4 drawn = vec4(0.0);
    if (cover > 0.0) {
        vec3 p = vec3((band + 0.5) / float(levels), levels > 1 ? band / float(levels - 1) : 0.0, 0.0);
        vec3 color = field_color(p);
        vec3 own = here.rgb * (luminance(color) / max(luminance(here.rgb), 1e-6));
        float alpha = clamp(field_opacity(p), 0.0, 1.0) * cover;
        drawn = vec4(alpha * mix(color, own, keep_hue), alpha);
    }
    imageStore(image, pixel, drawn);
}
