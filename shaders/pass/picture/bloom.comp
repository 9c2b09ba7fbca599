// Spreads the bright picture: halved level by level, then added back up (Raseta et al. 2025, section 3.8).
//
// In mode normal every level weighs what `radius` says and the weights sum to one: the bloom has
// the energy of the bright picture. In mode paper C_i += alpha U(C_{i+1}), which adds energy with
// every level. Mode gaussian blurs in one size: by nine taps across and nine down, again and again.
//@ option mode = normal {normal, paper, gaussian} : normal keeps the energy; paper as published there; gaussian: a separable blur
uniform sampler2D source;      //= input : the bright picture
uniform float radius;          //= 0.7 [0, 1] : how much of the light goes to the wider levels
uniform float alpha;           //= 0.8 [0, 4] : weight of each wider level in mode paper
uniform int levels;            //= 0 [0, 16] : how many halvings; 0: down to one pixel
uniform int passes;            //= 5 [1, 64] : of mode gaussian: how often it blurs, across and down each time
uniform int spread;            //= 1 [1, 64] pixels : of mode gaussian: distance of its taps, which makes it wider and coarser
uniform image2D color;         //= output rgba16f : the bloom

// One shader for all steps (pass/picture/bloom.c): STAGE_FIRST halves the source, STAGE_DOWN a level,
// STAGE_TAIL goes down and up again through all small levels, STAGE_UP adds a wider level to one, and
// STAGE_LAST the first level to the source. Mode gaussian has STAGE_BLUR_FIRST and STAGE_BLUR instead. Where
// the source is what a pass `bright` keeps of a picture and nobody else wants to see that, FROM_BRIGHT is 1
// and the picture is read instead.
#if FROM_BRIGHT
uniform float threshold, knee, limit, intensity; // of that pass
#include "bright/keep.glsl"
#endif

// Halving an odd size n = 2 m + 1: three texels by their share of the texel that they make, so that
// the mean of the picture stays what it was.
vec3 halving(int i, int n) {
    if (n == 1) return vec3(1.0, 0.0, 0.0);
    if ((n & 1) == 0) return vec3(0.5, 0.5, 0.0);
    int m = n / 2;
    return vec3(m - i, m, i + 1) / float(n);
}

vec3 blend(vec3 own, vec3 wide) {
#if MODE == MODE_PAPER
    return own + alpha * wide;
#else
    return mix(own, wide, radius);
#endif
}

#if !STAGE_TAIL
layout(local_size_x = 16, local_size_y = 16) in;
#endif

#if STAGE_FIRST || STAGE_LAST || STAGE_BLUR_FIRST
uniform sampler2D picture; // of any size

vec3 picture_bright(vec3 c) {
#if FROM_BRIGHT
    return bright_keep(c, BRIGHT_PAPER == 1);
#else
    return c;
#endif
}

vec3 picture_look(vec2 uv) { return picture_bright(textureLod(picture, uv, 0.0).rgb); }

// Of the finest level.
vec3 picture_at(ivec2 pixel, ivec2 size) {
#if SAME_SIZE
    return picture_bright(texelFetch(picture, pixel, 0).rgb);
#else
    return picture_look((vec2(pixel) + 0.5) / vec2(size));
#endif
}
#endif

#if STAGE_FIRST || STAGE_DOWN
uniform int width; // of the finer level
uniform int height;

vec3 finer_at(ivec2 texel) {
    ivec2 size = ivec2(width, height);
    texel = min(texel, size - 1);
#if STAGE_FIRST
    return picture_at(texel, size);
#else
    return texelFetch(source, texel, 0).rgb;
#endif
}

// A software device computes all of a loop that may be taken, hence the first four texels without.
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), base = 2 * pixel;
    if (any(greaterThanEqual(pixel, imageSize(color)))) return;
    vec3 wx = halving(pixel.x, width), wy = halving(pixel.y, height);
    vec3 sum = wy.x * (wx.x * finer_at(base) + wx.y * finer_at(base + ivec2(1, 0))) +
               wy.y * (wx.x * finer_at(base + ivec2(0, 1)) + wx.y * finer_at(base + ivec2(1, 1)));
    int odd = ((width | height) & 1) != 0 ? 5 : 0;
    for (int i = 0; i < odd; i++) {
        ivec2 at = i < 2 ? ivec2(2, i) : ivec2(i - 2, 2);
        sum += wx[at.x] * wy[at.y] * finer_at(base + at);
    }
    imageStore(color, pixel, vec4(sum, 1.0));
}
#elif STAGE_TAIL
#include "bloom/tail.glsl"
#elif STAGE_BLUR_FIRST || STAGE_BLUR
#include "bloom/gaussian.glsl"
#else
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
#if MODE == MODE_PAPER
    vec3 wide = textureLod(source, uv, 0.0).rgb;
#else
    // A 3x3 tent over the wider level by four bilinear taps: weights 1 2 1 in each direction.
    vec2 half_texel = 0.5 / vec2(textureSize(source, 0));
    vec3 wide = 0.25 * (textureLod(source, uv - half_texel, 0.0).rgb +
                        textureLod(source, uv + half_texel * vec2(1.0, -1.0), 0.0).rgb +
                        textureLod(source, uv + half_texel * vec2(-1.0, 1.0), 0.0).rgb +
                        textureLod(source, uv + half_texel, 0.0).rgb);
#endif
#if STAGE_LAST
    vec3 own = picture_at(pixel, size);
#else
    vec3 own = imageLoad(color, pixel).rgb;
#endif
    imageStore(color, pixel, vec4(blend(own, wide), 1.0));
}
#endif
