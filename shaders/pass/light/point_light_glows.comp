// The point lights as they are seen: spheres that glow, and the light that mist sends to the eye on its way from them.
//
// over { point_light_glows { from = {scene, point_lights}, mist = 0.01 }, lit } lays both over a picture; `depth` hides
// what is behind its surfaces. The mist is thin: it takes no light away, and light is scattered in it
// once, the same into all directions. What the eye then gets is known without a march: an integral of
// the point_light's falloff along the ray (as Sun et al., "A practical analytic single scattering model for
// real time rendering", SIGGRAPH 2005, for point lights without a range).
//@ option point_lights_by = auto {auto, all, tiles} : which point lights a pixel looks at: all of them, or (tiles) those that reach into what the eye sees of 16 by 16 pixels, which are found out first; auto: all where they are few
uniform float size;               //= 0.03 [0, 100] m : diameter of spheres whose point light says no radius; 0: these are not seen
uniform float brightness;         //= 1 [0, 1e6] : factor of the spheres' light: 1 is what the point_light's power gives them
uniform float mist;               //= 0 [0, 10] 1/m : how much mist scatters of the light that passes a metre of it
uniform sampler2D depth;          //= input optional : depth of the scene (m)
#include "lib/point_lights.glsl"
writeonly uniform image2D image;  //= output rgba16f : radiance, to be laid over a picture; opacity 0
#include "lib/frame.glsl"

const float PI = 3.14159265, MOST = 60000.0, LEAST = 0.01; // LEAST: m, from a point light

// Where the ray passes a point_light.
struct passing {
    float along; // m from the eye, nearest to the point light
    float away;  // m from the point light there
};

passing pass_by(point_light l, vec3 way) {
    vec3 to = l.position - frame.eye.xyz;
    float along = dot(to, way);
    return passing(along, length(to - along * way));
}

// Of a sphere that gives the point_light's light, never smaller than a pixel can show: `pixel` is what one is
// wide at a metre.
vec3 sphere_seen(point_light l, passing by, float end, float pixel) {
    float radius = l.radius > 0.0 ? l.radius : 0.5 * size, wide = by.along * pixel;
    if (radius <= 0.0 || by.along <= frame.lens.z || by.along > end) return vec3(0.0);
    float shown = max(radius, wide);
    float covered = clamp((shown - by.away) / wide + 0.5, 0.0, 1.0);
    return l.color * (brightness * covered / (PI * (shown * shown + wide * wide / 12.0))); // its soft edge, too
}

// The integral of the point_light's falloff at the distance sqrt(h h + s s), over s between two places. One
// arcus tangent or logarithm for both: their differences.
float falloff_sum(point_light l, float h, float from, float to) {
    float h2 = h * h, over = 1.0 / l.range;
    vec2 s = vec2(from, to), s2 = s * s, away = sqrt(h2 + s2);
    if (l.linear) {
        float turn = h2 * log((to + away.y) / max(from + away.x, 1e-12 * away.x));
        return to - from - 0.5 * over * (to * away.y - from * away.x + turn);
    }
    float over2 = over * over, over4 = over2 * over2;
    vec2 square = s * (h2 + s2 / 3.0), sixth = s * (h2 * h2 * h2 + s2 * (h2 * h2 + s2 * (0.6 * h2 + s2 / 7.0)));
    vec2 lost = over4 * (over4 * sixth - 2.0 * square);
    return atan(h * (to - from), h2 + from * to) / h + lost.y - lost.x;
}

vec3 mist_lit(point_light l, passing by, float end) {
    float h = max(by.away, max(l.radius, LEAST)), half_chord = sqrt(max(l.range * l.range - h * h, 0.0));
    float from = max(-by.along, -half_chord), to = min(end - by.along, half_chord);
    if (!(from < to)) return vec3(0.0);
    return l.color * (max(falloff_sum(l, h, from, to), 0.0) * mist / (4.0 * PI));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), picture = imageSize(image);
    if (any(greaterThanEqual(pixel, picture))) return;
    vec3 light = vec3(0.0);
#if HAS_POINT_LIGHTS
    vec2 uv = (vec2(pixel) + 0.5) / vec2(picture);
    vec3 way = frame_ray(uv);
    float deep = length(way), end = frame.lens.w * deep;
#if HAS_DEPTH
    end = min(end, deep * texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r);
#endif
    float wide = 2.0 * frame.lens.y / float(picture.y) / deep;
    for (point_light_list list = point_lights_at(pixel); point_lights_next(list);) {
        point_light l = point_lights_get(list);
        passing by = pass_by(l, way / deep);
        if (POINT_LIGHTS_SKIP && by.away >= l.range) continue;
        light += sphere_seen(l, by, end, wide);
        if (mist > 0.0) light += mist_lit(l, by, end);
    }
#endif
    imageStore(image, pixel, vec4(min(light, vec3(MOST)), 0.0));
}
