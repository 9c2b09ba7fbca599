// Marches a ray per pixel through the volume, front to back.
//
// Mode physical integrates emission and absorption (Max 1995) and single scattering of sun and sky
// exactly over each step, so that the picture converges as steps grow: over a step of length d with
// extinction s, opacity is 1 - exp(-s d). Mode paper is Raseta, Lesar and Bohak 2025, section 3.5, as published, but
// for its order of the two sums (colour first, as Max has it).
//@ option mode = physical {physical, paper} : how samples add up; paper: opacity / steps, as published
//@ option sampling = quasi_cubic {linear, quasi_cubic, cubic} : interpolation of grids: quasi_cubic by a smoothstep-warped coordinate (Raseta et al., listing 1), cubic by a B-spline of eight taps
//@ option view = beauty {beauty, noise} : noise shows the field `noise` on the faces of the volume's box
//@ field float density : extinction (1/m); in mode paper density in 0..1
//@ field vec3 radiance after density = {0, 0, 0} : light of the medium itself where it is opaque (in mode paper: its colour)
//@ field vec3 emission after density = {0, 0, 0} : light given off per metre, whatever the extinction
//@ field float shadow_density = 0 : extinction that shadows are made of, if it is to be cheaper than `density` (1/m); else that
//@ field float noise = 0 : what view = noise shows, 0..1
//@ counter samples : points at which the density was evaluated
uniform int steps;                 //= 128 [1, 4096] : steps along each ray, from entry to exit
uniform float step_size;           //= 0 [0, 100] m : length of a step instead; 0: use `steps`
uniform float jitter;              //= 0 [0, 1] : random part of a step by which a ray's samples move
uniform float early_exit;          //= 0.005 [0, 1] : a ray ends when less than this shines through
uniform float depth_bias;          //= 0.01 [0, 10] m : how far behind a surface a ray may go
uniform vec3 albedo;               //= {0.5, 0.5, 0.5} [0, 1] : part of the light that is scattered, by colour
uniform float anisotropy;          //= 0.2 [-0.95, 0.95] : Henyey-Greenstein g: 0 all directions, above 0 forward
uniform float ambient;             //= 1 [0, 10] : factor of the light from the sky
uniform int shadow_steps;          //= 8 [0, 64] : steps towards the sun from each lit point; 0: no sun
uniform float shadow_distance;     //= 4 [0.01, 1000] m : how far towards the sun shadows reach
uniform float opacity;             //= 20 [0, 1000] : factor of the density, mode paper only
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler2D depth;           //= input optional : depth of the scene (m)
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D shadow;  //= output r16f : part of the sunlight that reaches the scene at the pixel
writeonly uniform image2D edge;    //= output r32f : depth of the scene that the ray saw (m)

#include "lib/frame.glsl"
#include "lib/box.glsl"
#include "lib/random.glsl"
#include "fields.glsl"

const float PI = 3.14159265;

// Henyey and Greenstein 1941, times 4 pi: 1 in every direction when g is 0.
float phase(float cosine, float g) {
    return (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

float shadowing(vec3 p) {
#if HAS_SHADOW_DENSITY
    return field_shadow_density(p);
#else
    return field_density(p);
#endif
}

// Transmittance from p towards the sun; steps grow with distance, where detail matters less.
float sunlight(vec3 p) {
    float far = box_exit(p, frame.sun_direction.xyz, box_min, box_max);
    far = min(far, shadow_distance);
    float depth_sum = 0.0, from = 0.0;
    for (int i = 0; i < shadow_steps; i++) {
        float part = float(i + 1) / float(shadow_steps);
        float to = far * part * part;
        depth_sum += shadowing(p + 0.5 * (from + to) * frame.sun_direction.xyz) * (to - from);
        from = to;
    }
    count_samples(shadow_steps);
    return exp(-depth_sum);
}

// The shadow of the volume on a point outside of it: the same number of steps from where the ray to
// the sun enters the box to where it leaves.
float shadow_on(vec3 p) {
    vec2 range = box_range(p, frame.sun_direction.xyz, box_min, box_max);
    if (range.y <= range.x) return 1.0;
    int count = 2 * shadow_steps;
    float length = (range.y - range.x) / float(count), sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += shadowing(p + (range.x + (float(i) + 0.5) * length) * frame.sun_direction.xyz);
    count_samples(count);
    return exp(-sum * length);
}

struct ray_state {
    vec3 light;          // radiance so far
    float transmittance; // what still shines through
};

void add_physical(inout ray_state ray, vec3 p, vec3 direction, float d, float length) {
    vec3 own = field_radiance(p);
    vec3 given = field_emission(p);
    float cosine = dot(direction, frame.sun_direction.xyz);
    vec3 sky = 0.5 * (frame.sky_zenith.rgb + frame.sky_horizon.rgb);
    vec3 lit = ambient * sky;
    if (shadow_steps > 0)
        lit += frame.sun_radiance.rgb * (0.25 * phase(cosine, anisotropy) * sunlight(p));
    float x = d * length;
    float through = exp(-x);
    float opaque = x > 1e-2 ? 1.0 - through : x - 0.5 * x * x; // 1 - exp(-x) without cancellation
    vec3 gained = opaque * (own + albedo * lit) + given * (opaque / d);
    ray.light += ray.transmittance * gained;
    ray.transmittance *= through;
}

void add_paper(inout ray_state ray, vec3 p, float d) {
    float part = min(d * opacity / float(steps), 1.0);
    ray.light += ray.transmittance * part * field_radiance(p);
    ray.transmittance *= 1.0 - part;
}

// `last`: how far samples may lie. In mode paper it weighs samples and leaves the steps as they are
// (section 3.6); otherwise the ray ends there, so that the sum has a sharp end at a surface.
ray_state march(vec3 origin, vec3 direction, vec2 range, float last, float offset) {
    ray_state ray = ray_state(vec3(0.0), 1.0);
#if MODE != MODE_PAPER
    range.y = min(range.y, last);
#endif
    float span = range.y - range.x;
    if (span <= 0.0) return ray;
    int count = steps;
    float length = span / float(steps);
    if (step_size > 0.0) {
        length = max(step_size, span / 4096.0);
        count = int(ceil(span / length));
    }
    int taken = 0;
    for (int i = 0; i < count; i++) {
        // The last step of a fixed length ends at the exit.
        float from = range.x + float(i) * length;
        float part = min(length, range.y - from);
        float at = from + offset * part;
        if (at > last) break;
        vec3 p = origin + at * direction;
        float d = field_density(p);
        taken++;
        if (d <= 0.0) continue;
#if MODE == MODE_PAPER
        add_paper(ray, p, d);
#else
        add_physical(ray, p, direction, d, part);
#endif
        if (ray.transmittance < early_exit) break;
    }
    count_samples(taken);
    return ray;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    bool inside = all(lessThan(pixel, size));
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 along = frame_ray(uv);
    float metres = length(along); // along the ray for each metre of depth
    vec3 direction = along / metres;
    vec2 range = box_range(frame.eye.xyz, direction, box_min, box_max);
    float stop = 1e9, last = 1e30;
#if HAS_DEPTH
    stop = texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r;
    last = stop * metres + depth_bias;
#endif
    if (!inside) range = vec2(0.0);
    float offset = 0.5;
#if MODE == MODE_PAPER
    offset = 0.0;
#endif
    offset += jitter * (random_pixel(uvec2(pixel), frame.size.z ^ random_hash(frame.size.w)) - 0.5);

    vec4 result;
#if VIEW == VIEW_NOISE
    vec3 front = frame.eye.xyz + range.x * direction;
    result = min(range.y, last) > range.x ? vec4(vec3(field_noise(front)), 1.0) : vec4(0.0);
#else
    ray_state ray = march(frame.eye.xyz, direction, range, last, clamp(offset, 0.0, 1.0));
    result = vec4(ray.light, 1.0 - ray.transmittance);
#endif
    float lit = 1.0;
#if HAS_DEPTH && MODE == MODE_PHYSICAL
    if (inside && shadow_steps > 0 && stop < 1e8) lit = shadow_on(frame.eye.xyz + stop * along);
#endif
    if (!inside) return;
    imageStore(color, pixel, result);
    imageStore(shadow, pixel, vec4(lit));
    imageStore(edge, pixel, vec4(stop));
}
