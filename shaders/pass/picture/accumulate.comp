// Averages a picture over frames, a volume's above all: what the last frames gathered is fetched where
// the point that a pixel shows was seen then, kept near what is seen now, and mixed with it.
//
// The point is that at the distance `reach`, moved by the camera and by `velocity`. What moves otherwise
// is kept from leaving trails in two ways. The history is clipped to what is around the pixel by
// variance (Salvi 2016, "An excursion in temporal supersampling") in YCoCg (Karis 2014, "High-quality
// temporal supersampling") and in opacity. And what blue noise leaves alone, the blurred picture, need
// not be averaged: by `response` it is that of now, and only the difference to it is gathered. The history is not used where the point was
// out of the picture, or where something else stood then.
//@ field vec3 velocity = {0, 0, 0} : of what is seen (m/s), as far as it is known
#include "lib/frame.glsl"
#include "fields.glsl"
uniform sampler2D source;          //= input : premultiplied radiance and opacity, or the lit scene
uniform sampler2D reach;           //= input optional : how far along its ray lies what each pixel shows (m; 0: nothing); else that is the scene
uniform sampler2D depth;           //= input optional : depth of the scene (m)
uniform sampler2D volume;          //= input optional : premultiplied light and opacity of the volume in a picture of both, where what is more to be seen is followed; without: the source is of what `reach` says
uniform sampler2D before;          //= input history color : what was gathered up to the last frame
uniform sampler2D known;           //= input history state : `state` of the last frame
uniform float frames;              //= 8 [1, 64] : how many frames are averaged, in effect; 1: none
uniform float response;            //= 1 [0, 1] : how much of a change of the blurred picture is taken over at once; 1: all, 0: no more than of the rest
uniform float spread;              //= 1 [0, 10] : standard deviations by which the history may differ from what is around the pixel
uniform float depth_tolerance;     //= 0.1 [0.001, 1] : relative difference in depth that counts as something else
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity. The `transmittance` of a march, which counts where the extinction has a colour, can take an `accumulate` of its own
writeonly uniform image2D state;   //= output rgba16f : depth of the volume and of the scene (m; 0: none), frames gathered, how much was of the volume

const float MOST = 6e4; // what a half-float holds
const float FAR = MOST; // metres

// What a half-float cannot hold, or is no number, would spread through the history.
vec4 look(ivec2 texel) {
    vec4 c = texelFetch(source, texel, 0);
    return mix(vec4(0.0), min(c, MOST), greaterThan(c, vec4(0.0)));
}

// YCoCg and opacity.
vec4 encode(vec4 c) {
    return vec4(0.25 * (c.r + c.b) + 0.5 * c.g, 0.5 * (c.r - c.b), 0.5 * c.g - 0.25 * (c.r + c.b), c.a);
}

vec4 decode(vec4 c) {
    return vec4(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z, c.w);
}

struct surroundings { // of a pixel, 3 x 3
    vec4 mean, deviation; // encoded
    vec4 blurred;         // encoded, by weights 1 2 1 in each direction
    float nearest;        // of the volume, metres along the ray; 0: none
};

surroundings look_around(ivec2 pixel, ivec2 size) {
    vec4 sum = vec4(0.0), squares = vec4(0.0), blurred = vec4(0.0);
    float nearest = FAR;
    for (int i = 0; i < 9; i++) {
        ivec2 texel = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1);
        vec4 c = encode(look(texel));
        sum += c;
        squares += c * c;
        blurred += c * float((2 - abs(i % 3 - 1)) * (2 - abs(i / 3 - 1))) / 16.0;
#if HAS_REACH
        float far = texelFetch(reach, texel * textureSize(reach, 0) / size, 0).r;
        if (far > 0.0) nearest = min(nearest, far);
#endif
    }
    vec4 mean = sum / 9.0;
    return surroundings(mean, sqrt(max(squares / 9.0 - mean * mean, 0.0)), blurred, nearest < FAR ? nearest : 0.0);
}

// The history between its texels by a Catmull-Rom spline: five bilinear taps of sixteen texels, less
// the corners (Jimenez 2016, "Filmic SMAA").
vec4 fetch_smooth(vec2 uv) {
    vec2 size = vec2(textureSize(before, 0));
    vec2 at = uv * size, centre = floor(at - 0.5) + 0.5, f = at - centre;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (1.5 * f - 2.5);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f)), w3 = f * f * (0.5 * f - 0.5);
    vec2 w12 = w1 + w2;
    vec2 t0 = (centre - 1.0) / size, t12 = (centre + w2 / w12) / size, t3 = (centre + 2.0) / size;
    vec4 sum = w12.x * w12.y * textureLod(before, t12, 0.0);
    sum += w0.x * w12.y * textureLod(before, vec2(t0.x, t12.y), 0.0);
    sum += w3.x * w12.y * textureLod(before, vec2(t3.x, t12.y), 0.0);
    sum += w12.x * w0.y * textureLod(before, vec2(t12.x, t0.y), 0.0);
    sum += w12.x * w3.y * textureLod(before, vec2(t12.x, t3.y), 0.0);
    float corners = (w0.x + w3.x) * (w0.y + w3.y);
    return max(sum / (1.0 - corners), 0.0);
}

// The same weights as in look_around.
vec4 fetch_blurred(sampler2D from, vec2 uv) {
    vec2 half_texel = 0.5 / vec2(textureSize(from, 0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++)
        sum += textureLod(from, uv + half_texel * (2.0 * vec2(i & 1, i >> 1) - 1.0), 0.0);
    return 0.25 * sum;
}

// The blurred picture of now at a pixel as a camera sees it that is not moved within one.
vec4 blurred_now(vec2 uv, vec4 moved) {
    if (frame.sight.xy == vec2(0.0)) return moved;
    vec4 c = fetch_blurred(source, uv - vec2(0.5, -0.5) * frame.sight.xy / frame.lens.xy);
    return encode(mix(vec4(0.0), min(c, MOST), greaterThan(c, vec4(0.0))));
}

// Where a point was in the frame before: xy in the picture, z: metres deep.
vec3 look_back(vec3 p) {
    vec4 clip = frame.last * vec4(p, 1.0);
    return vec3(clip.w > 0.0 ? 0.5 * clip.xy / clip.w + 0.5 : vec2(-1.0), clip.w);
}

// 1: the history at `uv` is of the same volume before the same scene; 0: of another. The volume's
// depth counts only where both frames have one. The nearest of 3 x 3 texels counts, so that edges
// do not flicker.
float agreement(vec2 uv, float volume, float scene) {
    ivec2 size = textureSize(known, 0), centre = ivec2(uv * vec2(size));
    float apart_volume = 1e9, apart_scene = 1e9;
    for (int i = 0; i < 9; i++) {
        ivec2 texel = clamp(centre + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1);
        vec2 then = texelFetch(known, texel, 0).rg;
        bool both = volume > 0.0 && then.x > 0.0;
        apart_volume = min(apart_volume, both ? abs(then.x - volume) / volume : 0.0);
        apart_scene = min(apart_scene, scene > 0.0 ? abs(then.y - scene) / scene : 0.0);
    }
    return 1.0 - smoothstep(depth_tolerance, 2.0 * depth_tolerance, max(apart_volume, apart_scene));
}

// How much of what is seen near the pixel is of the volume: what it hides, or of the light.
float cover_of(vec2 uv, vec4 seen) {
#if HAS_REACH && HAS_VOLUME
    vec4 c = textureLod(volume, uv, 0.0);
    return clamp(max(c.a, 2.0 * encode(c).x / max(encode(seen).x, 1e-6) - 0.1), 0.0, 1.0);
#else
    return float(HAS_REACH);
#endif
}

// Depth of the scene at a pixel, and the least of 3 x 3: an edge moves as what is before it.
vec2 scene_at(vec2 uv) {
#if HAS_DEPTH
    ivec2 size = textureSize(depth, 0), centre = ivec2(uv * vec2(size));
    float here = min(texelFetch(depth, centre, 0).r, FAR), nearest = here;
#if HAS_VOLUME || !HAS_REACH
    for (int i = 0; i < 9; i++)
        nearest = min(nearest, texelFetch(depth, clamp(centre + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1), 0).r);
#endif
    return vec2(here, nearest);
#else
    return vec2(0.0);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    // Of a camera that is moved within a pixel the history is that of one that is not.
    vec3 along = frame_ray_still(uv);
    vec4 now = look(pixel);
    if (frame.time.w > 0.0) { // all of these are averaged
        imageStore(color, pixel, now);
        imageStore(state, pixel, vec4(0.0));
        return;
    }
    surroundings here = look_around(pixel, size);
    float cover = cover_of(uv, now), volume_deep = cover > 0.5 || HAS_DEPTH == 0 ? here.nearest / length(along) : 0.0;
    vec2 scenes = scene_at(uv);
    float scene = scenes.x, scene_then = scene > 0.0 ? look_back(frame.eye.xyz + scene * along).z : 0.0;
    vec3 point = frame.eye.xyz + (volume_deep > 0.0 ? volume_deep : scenes.y > 0.0 ? scenes.y : FAR) * along;
#if HAS_VELOCITY
    if (volume_deep > 0.0) point -= frame.time.y * field_velocity(point);
#endif
    vec3 then = look_back(point);

    float age = 0.0;
    vec4 result = now;
    if (all(greaterThanEqual(then.xy, vec2(0.0))) && all(lessThan(then.xy, vec2(1.0)))) {
        vec2 last = texelFetch(known, ivec2(then.xy * vec2(size)), 0).ba;
        age = last.x;
        age *= agreement(then.xy, volume_deep > 0.0 ? then.z : 0.0, scene_then);
        // The mean of an exponential average over `frames`; before, that of what there is.
        float part = max(2.0 / (frames + 1.0), 1.0 / (age + 1.0));
        vec4 turned = blurred_now(uv, here.blurred) - encode(fetch_blurred(before, then.xy));
        vec4 away = encode(fetch_smooth(then.xy)) - here.mean;
        // Of a surface the blurred picture changes by where in the pixel it was looked at.
        float prompt = HAS_VOLUME == 0 ? response : response * max(cover, last.y);
        if (prompt > part) away += (prompt - part) / (1.0 - part) * turned;
        // Rounding, which must not count, is a thousandth of what the numbers come from.
        vec4 beyond = abs(away) / (spread * here.deviation + vec4(vec3(1e-3 * here.mean.x), 1e-3) + 1e-6);
        away /= max(1.0, max(max(beyond.x, beyond.y), max(beyond.z, beyond.w)));
        result = max(mix(decode(here.mean + away), now, part), 0.0);
    }
    if (any(isnan(result))) result = vec4(0.0); // it would stay for ever
    imageStore(color, pixel, result);
    imageStore(state, pixel, vec4(volume_deep, scene, min(age + 1.0, 64.0), cover));
}
