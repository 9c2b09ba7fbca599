// Traces paths of light through volume, meshes and sky: what the picture would be if nothing were
// approximated. Without bias, but for noise that falls with the square root of the samples; the
// picture gathers as long as the effect stands still, and replaces the scene behind it.
//
// Null-collision transport: tentative collisions are drawn from bounds of the extinction (Woodcock
// et al. 1965) and weighed, so that a density beyond its bound does no harm (Galtier et al.,
// "Integral formulation of null-collision Monte Carlo algorithms", 2013), with probabilities by
// what a path still carries of each colour (Kutz et al., "Spectral and decomposition tracking",
// 2017). Light towards a source is found by ratio tracking (Novak et al., "Residual ratio tracking",
// 2014). Sources are drawn by what they would give unshadowed; sky, sun and glowing spheres are met by
// scattered paths, too, and both ways are weighed by the balance heuristic (Veach 1997). Emission counts at each tentative collision.
//
// Meshes are matte here: of their materials it minds the colours, and what they give off as the eye sees it.
//@ counter samples : points at which the density was evaluated
uniform int samples;               //= 1 [1, 64] : paths for each pixel and execution
uniform int bounces;               //= 64 [0, 1024] : how often light may be scattered, by the medium or a surface
uniform int filter_;               //= box {none, box, blackman_harris} : how samples lie in a pixel: all in its middle, all over it, or under a window of 1.5 pixels as in Cycles
uniform float haze;                //= 0 [0, 10] 1/m : as of the pass shade, whose pictures are compared: how fast distance fades surfaces to the colour of the horizon
uniform float sky_alpha;           //= 1 [0, 1] : opacity of the sky; 0 for pictures to be laid over others
uniform sampler2D depth;           //= input optional : depth of the scene (m), for `edge` only
uniform sampler2D sum_before;      //= input history sum : all samples so far
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D edge;    //= output r32f : depth of the scene at the pixel (m)
writeonly uniform image2D reach;   //= output r32f : distance along the ray at which it is first scattered, on average over the latest samples (m); of the scene where it is not
writeonly uniform image2D transmittance; //= output rgba16f optional : part of what is behind that shines through, the mean of its colours
uniform image2D sum;               //= output rgba32f : all samples, added up

uniform int paths; // for each pixel in this dispatch
uniform int part;  // which dispatch of the execution this is; each has the same number of paths

#include "lib/frame.glsl"
#include "lib/surface.glsl"
#include "lib/color.glsl"
#include "lib/medium.glsl"
#include "lib/majorant.glsl"
#include "lib/path.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/night.glsl"

// Where light is scattered: in the medium, or on a surface (`normal` is not zero).
struct path_vertex {
    vec3 p, normal, before;
};

const int TURNS = 1 << 18;                // of a path; it ends there
const float THIN = 0.02, THIN_LATE = 0.5; // Russian roulette below this part of the light, at first and later
const int LATE = 8;                       // scatterings

struct path_state {
    path_random random;
    vec3 weight;         // part of the light here that reaches the eye
    vec3 light;          // radiance so far
    float alpha;
    int bounce, turn;    // scatterings and rounds of the loop so far
    float first;         // metres to the first scattering
    vec3 from, way;      // of the next ray of the path
    bool begins, done;   // that ray begins; the path is at its end
    majorant_walk walk;  // of the ray that is traced just now
    bvh_hit hit;         // where it ends, unless it goes to a light
    bool to_light;       // it goes from the last scattering to a light
    vec3 arriving;       // light that comes this way, if nothing stops it
    path_vertex last;    // where the path was scattered last
    float pdf, total;    // density of the way from there; importance of all sources there
    bool passes;         // the ray has a sun or sphere in its way, if nothing stops it before
    float passed;        // metres of the ray that are looked through for them
};

float brightest(vec3 c) {
    return max(abs(c.r), max(abs(c.g), abs(c.b)));
}

// By phase function, or Lambertian; both are the density of the directions drawn, too.
float scattered(path_vertex v, vec3 way) {
    if (v.normal == vec3(0.0)) return medium_phase(dot(v.before, way), 1.0);
    return max(dot(v.normal, way), 0.0) / PATH_PI;
}

// What a source may give at a vertex. Not zero where it gives anything: a sphere shines over the
// horizon, too.
float importance_of(path_vertex v, light_ray at) {
    return luminance(at.irradiance) * (0.02 + scattered(v, at.direction));
}

// One source for the vertex, drawn by importance; -1: the sky. `share`: its part of the choices.
int choose_source(path_vertex v, float random, out float share, out float total) {
    int chosen = -1;
    float sky = luminance(sky_mean()), picked = sky;
    total = sky;
    for (int i = 0; i < light_count(); i++) {
        float importance = importance_of(v, light_at(light_get(i), v.p));
        if (importance <= 0.0) continue;
        total += importance;
        random *= total;
        bool take = random < importance;
        random = take ? random / importance : (random - importance) / (total - importance);
        if (!take) continue;
        chosen = i;
        picked = importance;
    }
    share = total > 0.0 ? picked / total : 0.0;
    return chosen;
}

// Sends a ray from the vertex to a source.
void ask_source(inout path_state s, path_vertex v, vec4 random) {
    float share;
    int chosen = choose_source(v, random.x, share, s.total);
    if (share <= 0.0) return;
    path_light source;
    if (chosen >= 0) {
        light l = light_get(chosen);
        source = path_sample_light(l, light_at(l, v.p), random.yz);
        source.radiance /= share + source.solid_angle * scattered(v, source.way);
    } else {
        float pdf;
        source.way = sky_sample(random.yz, pdf);
        source.far = 1e9;
        source.radiance = sky_radiance(source.way) / (share * pdf + scattered(v, source.way));
    }
    s.arriving = s.weight * source.radiance * scattered(v, source.way);
    if (brightest(s.arriving) <= 0.0 || bvh_occluded(v.p, source.way, 0.0, source.far * 0.9999)) return;
    s.walk = majorant_begin(v.p, source.way, source.far);
    s.to_light = true;
    s.begins = false;
}

void scatter(inout path_state s, path_vertex v) {
    if (s.bounce == 0) s.first = distance(v.p, s.walk.origin);
    s.bounce++;
    vec4 r = path_next(s.random);
    bool solid = v.normal != vec3(0.0);
    s.from = v.p;
    s.way = solid ? path_sample_cosine(v.normal, r.xy) : path_sample_phase(v.before, r.xyz);
    s.pdf = scattered(v, s.way);
    s.last = v;
    s.begins = true;
    ask_source(s, v, path_next(s.random));
}

// Ends paths that carry little, and makes up for it in those that are left.
void roulette(inout path_state s, float random) {
    float thin = s.bounce < LATE ? THIN : THIN_LATE, carried = brightest(s.weight);
    if (carried >= thin) return;
    s.done = random * thin >= carried;
    s.weight *= thin / max(carried, 1e-30);
}

// A tentative collision of a ray to a light.
void collide_to_light(inout path_state s, vec3 gone, float bound, float random) {
    s.arriving *= 1.0 - gone / bound;
    float thin = 0.1 * brightest(s.weight), carried = brightest(s.arriving);
    if (carried >= thin) return;
    bool ends = random * thin >= carried;
    s.arriving *= ends ? 0.0 : thin / carried;
    if (ends) s.walk.at = s.walk.end;
}

// A tentative collision of a path where the extinction is `gone`: light is given off. True: it is
// scattered, else it goes on.
bool collide(inout path_state s, vec3 p, float d, vec3 gone, float bound, vec2 random) {
    s.light += s.weight * medium_emission(p, d) / bound;
    vec3 back = s.bounce < bounces ? s.weight * d * medium_scattering(p) : vec3(0.0);
    vec3 on = s.weight * (bound - gone);
    float some = dot(abs(back), vec3(1.0)), none = dot(abs(on), vec3(1.0)), total = some + none;
    bool scatters = random.x * total < some;
    s.weight = scatters ? back * (total / (bound * some)) : on * (total / (bound * max(none, 1e-30)));
    roulette(s, random.y);
    return scatters;
}

// The path has met a surface, which scatters what it does not swallow.
path_vertex meet_surface(inout path_state s) {
    vec3 p = s.walk.origin + s.hit.distance * s.walk.direction;
    float behind = s.bounce == 0 ? frame.eye.w : 0.0; // of an orthographic camera
    float lift = 1e-4 * max(1.0, max(s.hit.distance - behind, brightest(p))) + 2e-7 * behind; // off the face: rounding
    if (s.bounce == 0) {
        float kept = exp(-haze * max(s.hit.distance - frame.eye.w, 0.0));
        s.light += s.weight * (1.0 - kept) * frame.sky_horizon.rgb;
        s.weight *= kept;
    }
#if MESHES_GLOW
    if (s.bounce == 0) s.light += s.weight * surface_emission(s.hit.what); // lights stand for what it lights
#endif
    s.weight *= s.hit.albedo;
    s.done = s.bounce >= bounces;
    if (!s.done) roulette(s, path_next(s.random).x);
    return path_vertex(p + lift * s.hit.normal, s.hit.normal, s.walk.direction);
}

// Light of the sun and of spheres that a scattered path meets between `passed` and `far` metres of
// its ray. They stop nothing. With `look` only: whether there are any.
bool meet_lights(inout path_state s, float far, bool look) {
    bool some = false;
    for (int i = 0; i < light_count(); i++) {
        light l = light_get(i);
        if (l.radius <= 0.0) continue;
        light_ray at = light_at(l, s.last.p);
        float sine = path_sine(l, at), solid_angle = path_solid_angle(sine);
        float importance = importance_of(s.last, at);
        if (solid_angle <= 0.0 || importance <= 0.0) continue;
        float there = path_meet_light(l, at, sine, s.way);
        if (there < s.passed || there > far) continue;
        some = true;
        if (look) break;
        float share = importance / s.total;
        s.light += s.weight * path_irradiance(at, sine) * (s.pdf / (solid_angle * s.pdf + share));
    }
    return some;
}

// The path has left everything behind.
void meet_sky(inout path_state s) {
    vec3 sky = s.weight * sky_radiance(s.walk.direction);
    s.done = true;
    if (s.bounce == 0) {
        float pixel = 2.0 * frame.lens.y / float(frame.size.y);
        s.light += sky_alpha * s.weight * night_sky(s.walk.direction, pixel);
        s.alpha -= (1.0 - sky_alpha) * dot(s.weight, vec3(1.0 / 3.0));
    } else {
        float share = s.total > 0.0 ? luminance(sky_mean()) / s.total : 0.0;
        s.light += sky * (s.pdf / (s.pdf + share * sky_pdf(s.walk.direction)));
    }
}

// From one tentative collision to the next, whatever the ray is for: what costs is written once, and
// neighbours do it together.
void advance(inout path_state s, vec3 highest, inout int taken) {
    if (s.begins) {
        s.hit = bvh_trace(s.from, s.way, 0.0, 1e9);
        s.walk = majorant_begin(s.from, s.way, s.hit.distance < 0.0 ? 1e9 : s.hit.distance);
        s.begins = s.to_light = false;
        s.passed = 0.0;
        s.passes = s.bounce > 0 && meet_lights(s, s.hit.distance < 0.0 ? 1e9 : s.hit.distance, true);
    }
    vec4 r = path_next(s.random);
    path_vertex v;
    float bound;
    bool scatters = false, collides = majorant_go(s.walk, -log(1.0 - r.x), bound);
    if (s.passes && !s.to_light) {
        float far = collides ? s.walk.at : s.hit.distance < 0.0 ? 1e9 : s.hit.distance;
        meet_lights(s, far, false);
        s.passed = far;
    }
    if (collides) {
        vec3 p = s.walk.origin + s.walk.at * s.walk.direction;
        float d = medium_density(p);
        taken++;
        v = path_vertex(p, vec3(0.0), s.walk.direction);
        if (d > 0.0 && s.to_light)
            collide_to_light(s, d * highest, bound, r.y);
        else if (d > 0.0)
            scatters = collide(s, p, d, d * highest, bound, r.yz);
    } else if (s.to_light) {
        s.light += s.arriving;
        s.begins = true;
    } else if (s.hit.distance >= 0.0) {
        v = meet_surface(s);
        scatters = true;
    } else {
        meet_sky(s);
    }
    if (++s.turn == TURNS) s.done = true;
    if (scatters && !s.done) scatter(s, v);
}

path_state begin(ivec2 pixel, ivec2 size, int number) {
    uint seed = random_hash(frame.size.z + random_hash(frame.size.w));
    path_state s;
    s.random = path_random(uvec3(pixel, uint(number) ^ seed), 0u);
    vec4 r = path_next(s.random);
    vec2 at = vec2(pixel) + 0.5 + path_sample_pixel(filter_, r.xy);
    s.weight = vec3(1.0);
    s.light = vec3(0.0);
    s.alpha = 1.0;
    s.bounce = s.turn = 0;
    s.first = 0.0;
    // What is in focus is seen at the same place from all over the lens.
    vec2 across = frame.sight.z * sqrt(r.z) * vec2(cos(2.0 * PATH_PI * r.w), sin(2.0 * PATH_PI * r.w));
    vec3 beside = (frame.view_inverse * vec4(across, 0.0, 0.0)).xyz;
    s.from = frame.eye.xyz + beside;
    s.way = normalize(frame_ray(at / vec2(size)) - beside / frame.sight.w);
    s.begins = true;
    s.done = false;
    return s;
}

// Radiance and opacity of a path that is done.
vec4 result_of(path_state s) {
    vec4 result = vec4(s.light, s.alpha);
    return any(isnan(result)) || any(isinf(result)) ? vec4(0.0) : result;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    bool inside = all(lessThan(pixel, size));
    vec3 highest = medium_extinction();
    vec4 total = vec4(0.0);
    vec2 firsts = vec2(0.0); // their sum and count
    int taken = 0, begun = 0, before = executed * samples + part * paths;
    path_state s;
    s.done = true;
    // A thread begins its next path at once: it does not wait for its neighbours.
    for (int i = 0; i < paths * TURNS && inside; i++) {
        if (s.done) {
            if (begun > 0) total += result_of(s);
            if (begun > 0 && s.first > 0.0) firsts += vec2(s.first, 1.0);
            if (begun == paths) break;
            s = begin(pixel, size, before + begun++);
        }
        advance(s, highest, taken);
    }
    count_samples(taken);
    if (!inside) return;
    if (part > 0) total += imageLoad(sum, pixel);
    else if (executed > 0) total += texelFetch(sum_before, pixel, 0);
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    float stop = 1e9;
#if HAS_DEPTH
    stop = texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r;
#endif
    imageStore(sum, pixel, total);
    vec4 mean = total / float(before + paths);
    imageStore(color, pixel, mean);
    imageStore(transmittance, pixel, vec4(vec3(1.0 - mean.a), 1.0));
    imageStore(edge, pixel, vec4(stop));
    imageStore(reach, pixel, vec4(firsts.y > 0.0 ? firsts.x / firsts.y : stop * length(frame_ray(uv))));
}
