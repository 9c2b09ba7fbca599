// Marches a ray per pixel through the volume, front to back.
//
// Mode physical integrates emission and absorption (Max 1995) and the scattering of light once on
// its way, exactly over each step, so that the picture converges as steps grow: over a step of
// length d with extinction s, opacity is 1 - exp(-s d). What is scattered more often is in `glow`,
// or, without it, what the option scattering estimates. Mode paper is Raseta, Lesar and Bohak 2025,
// section 3.5, as published, but for its order of the two sums (colour first, as Max has it).
//@ option mode = physical {physical, paper} : how samples add up; paper: opacity / steps, as published
//@ option view = beauty {beauty, noise} : noise shows the field `noise` on the faces of the volume's box
//@ option scattering = glow {glow, single, octaves} : of light that is scattered more than once: what `glow` says, if that is given; nothing; or an estimate by octaves (Wrenninge, Kulla and Lundqvist 2013)
//@ option mesh_shadows = off {off, on} : meshes shadow the volume, by a ray from each sample to each light; with `shadow` they do so anyway
//@ option skipping = on {off, on} : samples are taken only where the density may be above 0; off: everywhere, which changes nothing but the time
//@ option jitter_noise = blue {white, blue} : what `jitter` is made of: blue has its error where an eye or a mean over frames loses it
//@ counter samples : points at which the density was evaluated
//@ counter dense : of these, along the rays of pixels, where it is above 0
uniform int steps;                 //= 128 [1, 4096] : steps along each ray, from entry to exit
uniform float step_size;           //= 0 [0, 100] m : length of a step instead; 0: use `steps`
uniform float tolerance;           //= 0 [0, 1] : above 0: steps as long as they may be. A step is taken when two halves of it would change the pixel by no more than this: its opacity, or the medium's own light against 1 + the light before it. Samples are at most four steps of `steps` apart, and at least a sixteenth of one and an eighth of a pixel
uniform float jitter;              //= 0 [0, 1] : random part of a step by which a ray's samples move
uniform float early_exit;          //= 0.005 [0, 1] : a ray ends when less than this shines through
uniform float depth_bias;          //= 0.01 [0, 10] m : how far behind a surface a ray may go
uniform float ambient;             //= 1 [0, 10] : factor of the light from the sky, which is the same on all sides, without `glow`
uniform int shadow_steps;          //= 8 [0, 64] : steps towards each light from each lit point, without `shadow`; 0: no light
uniform float shadow_distance;     //= 4 [0.01, 1000] m : how far towards a light shadows reach, without `shadow`
uniform int near_steps;            //= 0 [0, 8] : steps towards each light through what a texel of `shadow` blurs
uniform int octaves;               //= 4 [1, 8] : of scattering
uniform float octave_extinction;   //= 0.5 [0, 1] : extinction on the way from a light, from octave to octave
uniform float octave_anisotropy;   //= 0.5 [0, 1] : anisotropy, from octave to octave
uniform float octave_contribution; //= 0.5 [0, 1] : light, from octave to octave
uniform float powder;              //= 0 [0, 1] : artistic: darkens what faces a light and is thin (Schneider 2015), as powder looks
uniform int bricks;                //= 0 [0, 129] : along the longest side of the volume's box: samples are not taken in bricks in which nothing can be; 0: 45, in software 33 or 15, and none where that would cost more than it saves
uniform int threads;               //= 0 [0, 16] : that share the samples of a ray: 1, 2, 4, 8 or 16, at most a subgroup; 0: as many as keep the device busy, in software one
uniform float opacity;             //= 20 [0, 1000] : factor of the density, mode paper only
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler2D depth;           //= input optional : depth of the scene (m)
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity, the mean of its colours: `transmittance` has each
writeonly uniform image2D edge;    //= output rg32f : up to which depth of the scene (m) the ray would have seen the same: of the one that it saw, 1e9 where nothing more can be behind; and from which: where the last of the volume lies before it
writeonly uniform image2D reach;   //= output r32f : distance along the ray at which the opacity lies, on average (m); where there is none, that of the scene
writeonly uniform image2D transmittance; //= output rgba16f optional : part of what is behind that shines through, by colour

#include "lib/frame.glsl"
#include "lib/box.glsl"
#include "lib/grid.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/medium.glsl"
#include "lib/lighting.glsl"
#include "lib/bricks.glsl"
//@ field float noise = 0 : what view = noise shows, 0..1
#if MESH_SHADOWS == MESH_SHADOWS_ON
#include "lib/bvh.glsl"
#endif

#define GLOWS (HAS_LIGHTS && HAS_GLOW && SCATTERING == SCATTERING_GLOW)

float greatest(vec3 v) { return max(max(v.x, v.y), v.z); }
float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// What is compiled of this file: a stage that makes bricks, or what rays see that miss the box, or
// else the march itself, which has code for steps of variable length where those are asked for.
#if defined(STAGE_HOLD) || defined(STAGE_FREE) || defined(STAGE_AROUND)
#define WITHOUT_RAYS
#endif
#ifndef ADAPTIVE
#define ADAPTIVE 1
#endif
#ifndef MARCH_SOFTWARE
#define MARCH_SOFTWARE 0
#endif

// Whether the density may be above 0.
bool may_hold(vec3 p) {
#if SKIPPING == SKIPPING_ON
    return bricks_may_hold(p, box_min, box_max);
#else
    return true;
#endif
}

#ifndef MAPS
#define MAPS 0 // more is kept of what a ray sees: maps.comp
#endif

#include "bricks.glsl"
#include "light.glsl"
#include "sum.glsl"

#if MARCH_SOFTWARE || defined(STAGE_AROUND)
uniform vec2 corner; // of the part of the picture at hand
#else
const vec2 corner = vec2(0.0);
#endif

const float NOTHING = 1e-6; // m: where the last of a volume lies that the ray does not meet

float scene_depth(vec2 uv) {
#if HAS_DEPTH
    return texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r;
#else
    return 1e9;
#endif
}

#if defined(STAGE_AROUND)
layout(local_size_x = 16, local_size_y = 16) in;

void main() {
    ivec2 pixel = ivec2(corner) + ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    float stop = scene_depth(uv);
    imageStore(color, pixel, vec4(0.0));
    imageStore(edge, pixel, vec4(1e9, NOTHING, 0.0, 0.0));
    imageStore(transmittance, pixel, vec4(1.0));
    imageStore(reach, pixel, vec4(stop * length(frame_ray(uv))));
#if MAPS
    maps_store_nothing(pixel);
#endif
}
#endif

#if !defined(WITHOUT_RAYS)
layout(local_size_x = 16, local_size_y = 16) in;

float chance(uvec2 pixel) {
    uint seed = random_hash(frame.size.w);
#if JITTER_NOISE == JITTER_NOISE_BLUE
    return random_blue(pixel + uvec2(seed, seed >> 8), frame.size.z);
#else
    return random_pixel(pixel, frame.size.z ^ seed);
#endif
}

// Neighbours in a subgroup are neighbours in the picture, both ways: they find the same things.
ivec2 pixel_of_thread() {
#if TEAMS
    uint i = (gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID) / uint(team);
    uint bits = findMSB(256 / team);
#else
    uint i = gl_LocalInvocationIndex, bits = 8u;
#endif
    uvec2 within = uvec2(0u);
    for (uint bit = 0u; bit < 4u; bit++) within |= uvec2(i, i >> 1) >> bit & 1u << bit;
    uvec2 tile = uvec2(1u << (bits + 1u) / 2u, 1u << bits / 2u);
    return ivec2(corner) + ivec2(gl_WorkGroupID.xy * tile + within);
}

void main() {
    ivec2 pixel = pixel_of_thread();
    ivec2 size = imageSize(color);
    bool inside = all(lessThan(pixel, size));
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 along = frame_ray(uv);
    float metres = length(along); // along the ray for each metre of depth
    vec3 direction = along / metres;
    vec2 range = box_range(frame.eye.xyz, direction, box_min, box_max);
    float stop = scene_depth(uv);
    float last = HAS_DEPTH != 0 ? stop * metres + depth_bias : 1e30;
    if (!inside) range = vec2(0.0);
    bool through = range.x >= range.y || range.y <= last; // no more of the box is behind the scene
    float offset = MODE == MODE_PAPER ? 0.0 : 0.5;
    offset = clamp(offset + jitter * (chance(uvec2(pixel)) - 0.5), 0.0, 1.0);

    pixel_width = 2.0 * frame.lens.y / float(size.y);
    ray_state ray = ray_begin();
#if MAPS
    maps_begin(frame.eye.xyz, direction, metres);
#endif
#if VIEW == VIEW_NOISE
    vec3 front = frame.eye.xyz + range.x * direction;
    if (min(range.y, last) > range.x) ray = ray_state(vec3(field_noise(front)), vec3(0.0), vec2(range.x, 1.0), range.x);
#elif MODE == MODE_PAPER
    ray = march_paper(frame.eye.xyz, direction, range, last, offset);
#else
    // The ray ends at the surface, so that the sum has a sharp end there.
    range.y = min(range.y, last);
#if ADAPTIVE
    if (tolerance > 0.0)
        ray = march_adaptive(frame.eye.xyz, direction, range, offset);
    else
#endif
        ray = march_even(frame.eye.xyz, direction, range, offset);
#endif
#if TEAMS
    ray.light = team_sum(ray.light);
    ray.reach = vec2(team_sum(ray.reach.x), team_sum(ray.reach.y));
    ray.until = team_greatest(ray.until);
#endif
    if (!inside || team_place() > 0) return;
    imageStore(color, pixel, vec4(ray.light, 1.0 - mean(ray.transmittance)));
    bool all = through || mean(ray.transmittance) < early_exit;
    imageStore(edge, pixel, vec4(all ? 1e9 : stop, clamp(ray.until / metres, NOTHING, stop), 0.0, 0.0));
    imageStore(transmittance, pixel, vec4(ray.transmittance, 1.0));
    imageStore(reach, pixel, vec4(ray.reach.y > 0.0 ? ray.reach.x / ray.reach.y : stop * metres));
#if MAPS
    maps_store(pixel);
#endif
}
#endif
