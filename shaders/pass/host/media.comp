// Several media as one: what each shows through those that lie before it.
//
// Of two whose stretches of a ray do not meet, the nearer one lies before the other. Where they go
// through each other each does so in a part, by how far their places are from each other, so that
// no edge shows where they change sides: light is then the mean of both orders.
#include "lib/frame.glsl"
uniform sampler2D color_a;         //= input : of a pass march or maps, all of one size: premultiplied radiance and opacity
uniform sampler2D transmittance_a; //= input : part of what is behind that shines through, by colour
uniform sampler2D reach_a;         //= input : distance along the ray at which the opacity lies (m)
uniform sampler2D edge_a;          //= input : its second number: depth at which the last of it lies (m)
uniform sampler2D moves_a;         //= input optional : image motion of a pass maps; without it nothing moves but the camera
uniform sampler2D color_b;         //= input : the same of a second one
uniform sampler2D transmittance_b; //= input : the same
uniform sampler2D reach_b;         //= input : the same
uniform sampler2D edge_b;          //= input : the same
uniform sampler2D moves_b;         //= input optional : the same
uniform sampler2D color_c;         //= input optional : the same of a third one
uniform sampler2D transmittance_c; //= input optional : the same
uniform sampler2D reach_c;         //= input optional : the same
uniform sampler2D edge_c;          //= input optional : the same
uniform sampler2D moves_c;         //= input optional : the same
writeonly uniform image2D color;         //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D transmittance; //= output rgba16f : part of what is behind that shines through, by colour
writeonly uniform image2D reach;         //= output r32f : distance along the ray at which the opacity lies, on average (m); where there is none, that of the scene
writeonly uniform image2D motion;        //= output rgba16f optional : mean of what was given, by what is seen of each; its weight

struct medium {
    vec3 light, through;
    float at, before, behind; // metres along the ray, from there to its front and to its end
    vec3 moves;
};

float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// Where it begins is not told. It is as far before the mean of the opacity as with an even density:
// half of the way where it is thin, and less the thicker it is.
medium medium_of(vec4 light, vec3 through, float at, float end, vec3 moves) {
    medium m = medium(light.rgb, through == through.gbr ? vec3(1.0 - light.a) : through, at, 0.0, max(end - at, 0.0), moves);
    float thin = clamp(mean(m.through), 1e-3, 0.999), middle = -1.0 / log(thin) - thin / (1.0 - thin);
    m.before = m.behind * middle / (1.0 - middle);
    return m;
}

// The part of `m` that lies before `other`, in 0..1.
float before(medium m, medium other) {
    bool first = m.at < other.at;
    float apart = first ? m.behind + other.before : other.behind + m.before;
    return clamp(0.5 + 0.5 * (other.at - m.at) / max(apart, 1e-6), 0.0, 1.0);
}

#define MEDIUM(X) medium_of(texelFetch(color_##X, pixel, 0), texelFetch(transmittance_##X, pixel, 0).rgb, \
                            texelFetch(reach_##X, pixel, 0).r, texelFetch(edge_##X, pixel, 0).g * metres, MOVES_##X)
#if HAS_MOVES_A
#define MOVES_a texelFetch(moves_a, pixel, 0).xyz
#else
#define MOVES_a vec3(0.0)
#endif
#if HAS_MOVES_B
#define MOVES_b texelFetch(moves_b, pixel, 0).xyz
#else
#define MOVES_b vec3(0.0)
#endif
#if HAS_MOVES_C
#define MOVES_c texelFetch(moves_c, pixel, 0).xyz
#else
#define MOVES_c vec3(0.0)
#endif
#if HAS_COLOR_C
const int COUNT = 3;
#else
const int COUNT = 2;
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    float metres = length(frame_ray((vec2(pixel) + 0.5) / vec2(size))); // along the ray for each of depth
    medium all[COUNT];
    all[0] = MEDIUM(a);
    all[1] = MEDIUM(b);
#if HAS_COLOR_C
    all[2] = MEDIUM(c);
#endif
    vec3 light = vec3(0.0), through = vec3(1.0);
    vec4 moves = vec4(0.0); // and what is seen of all
    float at = 0.0;
    for (int i = 0; i < COUNT; i++) {
        vec3 shown = vec3(1.0); // through those before it
        for (int k = 0; k < COUNT; k++)
            if (k != i) shown *= mix(vec3(1.0), all[k].through, before(all[k], all[i]));
        float seen = mean(shown * (1.0 - all[i].through));
        light += shown * all[i].light;
        through *= all[i].through;
        at += seen * all[i].at;
        moves += seen * vec4(all[i].moves, 1.0);
    }
    imageStore(color, pixel, vec4(light, 1.0 - mean(through)));
    imageStore(transmittance, pixel, vec4(through, 1.0));
    imageStore(reach, pixel, vec4(moves.w > 0.0 ? at / moves.w : all[0].at));
    imageStore(motion, pixel, moves.w > 0.0 ? vec4(moves.xyz / moves.w, moves.w) : vec4(0.0));
}
