// The lights of the scene, and what of each would reach a point if nothing stood between.
//
// They are the block "Lights" (shared.h), or, where a pass has the input `lights`, what the pass
// `lighting` made of them: the same and those that stand for the volume's own fire.
#ifndef LIB_LIGHT_GLSL
#define LIB_LIGHT_GLSL
#include "shared.h"

#ifndef HAS_LIGHTS
#define HAS_LIGHTS 0
#endif

struct light {
    vec3 position; // metres; of the sun: unit, towards it
    float radius;  // metres; of the sun: sine of its angular radius
    vec3 color;    // W/sr; of the sun: W/m^2 at normal incidence
    int kind;      // LIGHT_SUN, LIGHT_POINT, LIGHT_SPOT, LIGHT_FIRE
    vec3 axis;     // of a spot, and of fire
    float outer;   // cosine at which its cone ends
    float inner;   // cosine up to which it is full
    float range;   // metres; 0: it has none
    bool linear;   // falls off so, up to its range
};

struct light_ray {
    vec3 direction;  // unit, towards the light's centre
    float distance;  // metres to the light's centre; 1e9 for the sun
    vec3 irradiance; // at normal incidence, W/m^2
};

#if HAS_LIGHTS
// `lights` has a row for each: texels 0 to 3 are its light_entry (lighting.glsl says what follows).
int light_count() {
    return textureSize(lights, 0).y;
}

light_entry light_entry_of(int index) {
    return light_entry(texelFetch(lights, ivec2(0, index), 0), texelFetch(lights, ivec2(1, index), 0),
                       texelFetch(lights, ivec2(2, index), 0), texelFetch(lights, ivec2(3, index), 0));
}
#elif defined(RIG) && RIG != RIG_NONE

// Three suns, red, green and blue, each of which sends what a white wall has a radiance of 1 by; or
// three dark ones. The shader includes lib/frame.glsl before.
int light_count() {
    return 3;
}

light_entry light_entry_of(int index) {
    vec3 which = vec3(equal(ivec3(index), ivec3(0, 1, 2)));
    vec3 to = (frame.view_inverse * vec4(which * vec3(1.0, 1.0, -1.0), 0.0)).xyz;
    if (RIG != RIG_RIGHT_TOP_BACK) to = -to;
    if (RIG == RIG_OWN) which = vec3(0.0);
    return light_entry(vec4(to, 0.0), vec4(3.14159265 * which, float(LIGHT_SUN)), vec4(0.0), vec4(0.0));
}
#else
layout(std140) uniform Lights { light_block light_list; };

int light_count() {
    return int(light_list.count.x);
}

light_entry light_entry_of(int index) {
    return light_list.lights[index];
}
#endif

light light_get(int index) {
    light_entry e = light_entry_of(index);
    return light(e.position.xyz, e.position.w, e.color.rgb, int(e.color.w), e.axis.xyz, e.axis.w,
                 e.spread.x, e.spread.y, e.spread.z == 1.0);
}

// Part of a light's intensity that is its irradiance at a distance. A sphere's falls with the square of
// the distance only outside of it: inside it is that at its surface. The inverse square is let down to 0
// at the range by (1 - (d / range)^4)^2, which leaves most of it as it is (Karis, "Real shading in Unreal
// Engine 4", 2013, Lagarde and de Rousiers, "Moving Frostbite to physically based rendering", 2014,
// section 3.1.1).
float light_falls(float distance, float radius, float range, bool linear) {
    float part = min(distance / max(range, 1e-6), 1.0), square = part * part, window = 1.0 - square * square;
    float least = max(radius, 1e-2);
    return linear ? 1.0 - part : window * window / max(distance * distance, least * least);
}

light_ray light_at(light l, vec3 p) {
    if (l.kind == LIGHT_SUN) return light_ray(l.position, 1e9, l.color);
    vec3 to = l.position - p;
    float distance = max(length(to), 1e-4);
    vec3 direction = to / distance;
    vec3 irradiance = l.color * light_falls(distance, l.radius, l.range > 0.0 ? l.range : 1e30, l.linear);
    if (l.kind == LIGHT_SPOT) {
        float cosine = dot(-direction, l.axis);
        float least = clamp(1e-3 * (1.0 - l.outer), 1.2e-7, 1e-4); // an edge, however narrow the cone
        irradiance *= smoothstep(l.outer, max(l.inner, l.outer + least), cosine);
    }
    if (l.kind == LIGHT_FIRE) irradiance *= max(1.0 - dot(direction, l.axis), 0.0);
    return light_ray(direction, distance, irradiance);
}

#endif
