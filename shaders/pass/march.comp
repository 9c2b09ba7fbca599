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
//@ option jitter_noise = blue {white, blue} : what `jitter` is made of: blue has its error where an eye or a mean over frames loses it
//@ counter samples : points at which the density was evaluated
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
uniform float opacity;             //= 20 [0, 1000] : factor of the density, mode paper only
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler2D depth;           //= input optional : depth of the scene (m)
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity, the mean of its colours: `transmittance` has each
writeonly uniform image2D edge;    //= output r32f : depth of the scene that the ray saw (m)
writeonly uniform image2D reach;   //= output r32f : distance along the ray at which the opacity lies, on average (m); where there is none, that of the scene
writeonly uniform image2D transmittance; //= output rgba16f optional : part of what is behind that shines through, by colour

#include "lib/frame.glsl"
#include "lib/box.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/medium.glsl"
#include "lib/lighting.glsl"
//@ field float noise = 0 : what view = noise shows, 0..1
#if MESH_SHADOWS == MESH_SHADOWS_ON
#include "lib/bvh.glsl"
#endif

#define GLOWS (HAS_LIGHTS && HAS_GLOW && SCATTERING == SCATTERING_GLOW)

const float SHORTEST = 1.0 / 8192.0; // part of a ray that a step of variable length has at least
const int MOST_SAMPLES = 65000;

float greatest(vec3 v) { return max(max(v.x, v.y), v.z); }
float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// ---- light ------------------------------------------------------------------------------------

// Density times metres along a ray from p; steps grow with distance, where detail matters less.
float depth_along(vec3 p, vec3 direction, float far, int count) {
    float sum = 0.0, from = 0.0;
    for (int i = 0; i < count; i++) {
        float part = float(i + 1) / float(count);
        float to = far * part * part;
        sum += medium_density(p + 0.5 * (from + to) * direction) * (to - from);
        from = to;
    }
    count_samples(count);
    return sum;
}

struct obstacle {
    vec3 depth;    // optical, of the volume
    float visible; // part of the light that no mesh hides
};

#if HAS_LIGHTS && HAS_SHADOW
obstacle before_light(int index, light l, light_ray ray, vec3 p) {
    vec3 depth = vec3(0.0), from = p;
    if (near_steps > 0) {
        float texel = greatest(box_max - box_min) / float(textureSize(shadow, 0).x);
        float near = min(texel, max(ray.distance - l.radius, 0.0));
        depth = medium_extinction() * depth_along(p, ray.direction, near, near_steps);
        from += near * ray.direction;
    }
    vec2 cached = lighting_shadow(index, from);
    return obstacle(depth + lighting_extinction() * cached.x, cached.y);
}
#else
obstacle before_light(int index, light l, light_ray ray, vec3 p) {
    float far = max(ray.distance - l.radius, 0.0);
#if MESH_SHADOWS == MESH_SHADOWS_ON
    if (bvh_occluded(p, ray.direction, 1e-3, far)) return obstacle(vec3(0.0), 0.0);
#endif
    far = min(far, box_exit(p, ray.direction, box_min, box_max));
    // What the smoke takes of the light of its fire is off that light's colour already.
    bool taken = l.kind == LIGHT_FIRE;
    float density = taken ? 0.0 : depth_along(p, ray.direction, min(far, shadow_distance), shadow_steps);
    return obstacle(medium_extinction() * density, shadow_steps > 0 ? 1.0 : 0.0);
}
#endif

// Part of a light's irradiance that is scattered into a direction, 1/sr.
vec3 scattered_part(float cosine, vec3 depth) {
#if SCATTERING == SCATTERING_OCTAVES
    vec3 sum = vec3(0.0);
    float part = 1.0, through = 1.0, spread = 1.0;
    for (int i = 0; i < octaves; i++) {
        sum += part * medium_phase(cosine, spread) * exp(-through * depth);
        part *= octave_contribution;
        through *= octave_extinction;
        spread *= octave_anisotropy;
    }
#else
    vec3 sum = medium_phase(cosine, 1.0) * exp(-depth);
#endif
    return sum * mix(vec3(1.0), 1.0 - exp(-2.0 * depth), powder);
}

// Radiance that a metre of scattering coefficient 1 adds to a ray at p.
vec3 scattered_light(vec3 p, vec3 direction) {
#if GLOWS
    vec3 sum = lighting_scattered(p, -direction, medium_anisotropy());
    int count = lighting_declared();
#else
    vec3 sum = ambient * sky_mean();
    int count = light_count();
#endif
    for (int i = 0; i < count; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, p);
        if (greatest(ray.irradiance) <= 0.0) continue;
        obstacle before = before_light(i, l, ray, p);
        if (before.visible <= 0.0) continue;
        float cosine = dot(direction, ray.direction);
        sum += ray.irradiance * before.visible * scattered_part(cosine, before.depth);
    }
    return sum;
}

// ---- the sum along a ray ----------------------------------------------------------------------

struct ray_state {
    vec3 light;         // radiance so far
    vec3 transmittance; // what still shines through
    vec2 reach;         // opacities times distances, opacities
};

struct node { // the medium at a point of the ray
    float density;
    vec3 own;        // radiance that it adds in a metre
    vec3 scattering; // 1/m
};

node look(vec3 p) {
    node n = node(medium_density(p), vec3(0.0), vec3(0.0));
    if (n.density > 0.0) {
        n.own = medium_emission(p, n.density);
        n.scattering = n.density * medium_scattering(p);
    }
    return n;
}

node halfway(node a, node b) {
    return node(0.5 * (a.density + b.density), 0.5 * (a.own + b.own),
                0.5 * (a.scattering + b.scattering));
}

// The integral of exp(-x s) over s from 0 to 1, without cancellation.
vec3 held(vec3 x) {
    return mix((1.0 - exp(-x)) / max(x, 1e-6), 1.0 - x * (0.5 - x / 6.0), lessThan(x, vec3(1e-2)));
}

// A stretch of `length` metres that is everywhere as `n`, around the point `at` metres along.
void add_stretch(inout ray_state ray, node n, vec3 lit, float length, float at) {
    vec3 x = n.density * length * medium_extinction();
    vec3 whole = held(x);
    float gained = mean(ray.transmittance * x * whole);
    ray.light += ray.transmittance * whole * length * (n.own + n.scattering * lit);
    ray.transmittance *= exp(-x);
    ray.reach += gained * vec2(at, 1.0);
}

void add_paper(inout ray_state ray, vec3 p, float d, float at) {
    float part = min(d * opacity / float(steps), 1.0);
    ray.reach += ray.transmittance.x * part * vec2(at, 1.0);
    ray.light += ray.transmittance * part * field_radiance(p);
    ray.transmittance *= 1.0 - part;
}

struct step_nodes { // of a step that may be halved
    int known;      // nodes so far: none, its begin, its end too
    node begin, end;
};

// What the pixel would change by if a step of `length` metres were taken as two halves.
float halving(ray_state ray, step_nodes s, node middle, float length) {
    node ends = halfway(s.begin, s.end);
    vec3 extinction = medium_extinction() * length;
    vec3 one = ends.density * extinction;
    vec3 two = 0.5 * (ends.density + middle.density) * extinction;
    vec3 own = 0.5 * length * abs(ends.own - middle.own) * held(two);
    return greatest(ray.transmittance * max(abs(exp(-one) - exp(-two)), own / (1.0 + ray.light)));
}

// The light where the sample in the middle of a step lies, for the whole of it.
vec3 light_of_step(step_nodes s, node middle, vec3 p, vec3 direction) {
    vec3 scattering = middle.scattering;
    if (s.known == 2) scattering += s.begin.scattering + s.end.scattering;
    return greatest(scattering) > 0.0 ? scattered_light(p, direction) : vec3(0.0);
}

// A step whose middle is `at` metres along: as its sample is, or as two halves, each with the mean
// of its ends.
void add_step(inout ray_state ray, step_nodes s, node middle, vec3 lit, float length, float at) {
    if (s.known < 2) {
        add_stretch(ray, middle, lit, length, at);
    } else {
        add_stretch(ray, halfway(s.begin, middle), lit, 0.5 * length, at - 0.25 * length);
        add_stretch(ray, halfway(middle, s.end), lit, 0.5 * length, at + 0.25 * length);
    }
}

// `range`: where the ray enters and leaves; `offset`: where in a step its sample lies, in 0..1;
// `pixel`: width of a pixel at a distance of a metre.
//
// Without a tolerance a step has one sample. Else it has one at each end and one in the middle, and
// is halved until it is good enough: the middle is then the new end. Both ways share a loop, so
// that fields and lights are in the code once.
ray_state march(vec3 origin, vec3 direction, vec2 range, float offset, float pixel) {
    ray_state ray = ray_state(vec3(0.0), vec3(1.0), vec2(0.0));
    float span = range.y - range.x;
    if (span <= 0.0) return ray;
    bool even = tolerance <= 0.0;
    float usual = step_size > 0.0 ? max(step_size, span / 4096.0) : span / float(steps);
    float from = range.x, length = min(even ? usual : 2.0 * usual * max(offset, 0.05), span);
    step_nodes s;
    s.known = 0;
    int taken = 0, done = 0;
    while (length > 1e-6 * span && taken < MOST_SAMPLES) {
        float at = from + length * (even ? offset : s.known == 2 ? 0.5 : float(s.known));
        vec3 p = origin + at * direction;
        node n = look(p);
        taken++;
        float change = 0.0;
        if (!even) {
            if (s.known < 2) {
                if (s.known++ == 0)
                    s.begin = n;
                else
                    s.end = n;
                continue;
            }
            change = halving(ray, s, n, length);
            float least = max(max(0.125 * usual, SHORTEST * span), 0.25 * pixel * from);
            if (change > tolerance && length > least) {
                length *= 0.5;
                s.end = n;
                continue;
            }
        }
        add_step(ray, s, n, light_of_step(s, n, p, direction), length, at);
        if (mean(ray.transmittance) < early_exit) break;
        done++;
        from = even ? range.x + float(done) * usual : from + length;
        if (even) {
            length = usual;
        } else {
            // What halving changes falls with the cube of the length.
            if (change < 0.0625 * tolerance) length = min(2.0 * length, 8.0 * usual);
            s.begin = s.end;
            s.known = 1;
        }
        length = min(length, range.y - from);
    }
    count_samples(taken);
    return ray;
}

// Section 3.6: `last`, how far samples may lie, weighs them and leaves the steps as they are.
ray_state march_paper(vec3 origin, vec3 direction, vec2 range, float last, float offset) {
    ray_state ray = ray_state(vec3(0.0), vec3(1.0), vec2(0.0));
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
        float from = range.x + float(i) * length;
        float at = from + offset * min(length, range.y - from);
        if (at > last) break;
        vec3 p = origin + at * direction;
        float d = medium_density(p);
        taken++;
        if (d <= 0.0) continue;
        add_paper(ray, p, d, at);
        if (ray.transmittance.x < early_exit) break;
    }
    count_samples(taken);
    return ray;
}

float chance(uvec2 pixel) {
    uint seed = random_hash(frame.size.w);
#if JITTER_NOISE == JITTER_NOISE_BLUE
    return random_blue(pixel + uvec2(seed, seed >> 8), frame.size.z);
#else
    return random_pixel(pixel, frame.size.z ^ seed);
#endif
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
    float offset = MODE == MODE_PAPER ? 0.0 : 0.5;
    offset = clamp(offset + jitter * (chance(uvec2(pixel)) - 0.5), 0.0, 1.0);

    ray_state ray = ray_state(vec3(0.0), vec3(1.0), vec2(0.0));
#if VIEW == VIEW_NOISE
    vec3 front = frame.eye.xyz + range.x * direction;
    if (min(range.y, last) > range.x) ray = ray_state(vec3(field_noise(front)), vec3(0.0), vec2(range.x, 1.0));
#elif MODE == MODE_PAPER
    ray = march_paper(frame.eye.xyz, direction, range, last, offset);
#else
    // The ray ends at the surface, so that the sum has a sharp end there.
    range.y = min(range.y, last);
    ray = march(frame.eye.xyz, direction, range, offset, 2.0 * frame.lens.y / float(size.y));
#endif
    if (!inside) return;
    imageStore(color, pixel, vec4(ray.light, 1.0 - mean(ray.transmittance)));
    imageStore(edge, pixel, vec4(stop));
    imageStore(transmittance, pixel, vec4(ray.transmittance, 1.0));
    imageStore(reach, pixel, vec4(ray.reach.y > 0.0 ? ray.reach.x / ray.reach.y : stop * metres));
}
