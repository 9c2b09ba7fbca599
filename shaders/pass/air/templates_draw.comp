// Puts the templates of all groups into an image over simulated air, on top of the force that it has: how the
// air is pushed (m/s^2), and how much of it comes out of each place in a second (1/s). A thread does a texel,
// and looks at the templates of its tile alone.
//
// A picture is of a plane. Turned about the line upwards through its middle, it is itself on both sides of
// that line; between, what differs on the two sides goes over from one to the other by the cosine of the
// angle. So whatever it shows is as it is there, and smooth on the line.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#define TEMPLATES_USE readonly
#include "pass/air/templates_state.glsl"
#include "lib/template_pictures.glsl"
#if HAS_OWN_FORCE
uniform sampler3D own_force; // m/s^2
#endif
uniform writeonly image3D acceleration; //= output rgba16f : m/s^2; 1/s

const float FADE = 0.3; // of what is extruded: standard deviation, in halves of the side, as of a picture's border

// `at`: from the middle, in halves of the side, along right, up and depth.
vec4 extruded(vec3 at, vec4 right, vec4 up, float tile, float level) {
    vec4 held = template_picture(at.xy, tile, level) * exp(-0.5 * at.z * at.z / (FADE * FADE));
    return vec4(right.xyz * held.x + up.xyz * held.y, held.z);
}

vec4 revolved(vec3 at, vec4 right, vec4 up, float tile, float level) {
    float radius = length(at.xz);
    if (radius > 1.0) return vec4(0.0);
    vec2 way = at.xz / max(radius, 1e-6);
    vec4 a = template_picture(vec2(radius, at.y), tile, level), b = template_picture(vec2(-radius, at.y), tile, level);
    vec4 even = 0.5 * (a + b), odd = 0.5 * (a - b);
    vec3 depth = cross(right.xyz, up.xyz);
    // To the right: what is odd goes outwards, what is even to the right.
    vec3 push = odd.x * (way.x * right.xyz + way.y * depth) + even.x * right.xyz;
    return vec4(push + (even.y + way.x * odd.y) * up.xyz, even.z + way.x * odd.z);
}

// Pictures are read two levels finer than texels are: revolved, what a coarse level smears outwards counts more.
void add(uint i, vec3 texel, inout vec4 sum) {
    vec4 place = templates[template_at(0u, 0, i)];
    if (place.w <= 0.0) return;
    vec4 right = templates[template_at(1u, 0, i)], up = templates[template_at(2u, 0, i)];
    vec3 d = (texel - place.xyz) / place.w;
    vec3 at = vec3(dot(d, right.xyz), dot(d, up.xyz), dot(d, cross(right.xyz, up.xyz)));
    if (max(abs(at.x), max(abs(at.y), abs(at.z))) > 1.0) return;
    int look = int(up.w);
    float tile = float(look >> 2), level = template_level(4.0 * place.w);
    vec4 held = (look & TEMPLATE_EXTRUDED) != 0 ? extruded(at, right, up, tile, level)
                                                : revolved(at, right, up, tile, level);
    sum += right.w * held * ((look & TEMPLATE_PUSHES) != 0 ? vec4(1.0, 1.0, 1.0, 0.0) : vec4(0.0, 0.0, 0.0, 1.0));
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, TEMPLATES_SIZE))) return;
    ivec3 tile = texel / TEMPLATES_TILE;
    uint now = template_mask_at(parity, tile);
    vec4 sum = vec4(0.0);
#if HAS_OWN_FORCE
    sum.xyz = texelFetch(own_force, texel, 0).xyz;
#endif
    for (int w = 0; w < TEMPLATES_WORDS; w++) {
        uint bits = template_masks[now + uint(w)];
        while (bits != 0u) {
            add(uint(w * 32 + findLSB(bits)), vec3(texel) + 0.5, sum);
            bits &= bits - 1u;
        }
    }
    if (texel == tile * TEMPLATES_TILE) template_clear(tile);
    imageStore(acceleration, texel, clamp(sum, vec4(-65504.0), vec4(65504.0)));
}
