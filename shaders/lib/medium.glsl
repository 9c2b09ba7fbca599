// The medium: what fills the volume, and what it does to light. Every pass that includes this file
// takes the same fields and numbers; `from` hands them from one pass to the next.
//
// Extinction, scattering and absorption are the density times a colour, as in Blender's Principled
// Volume: of the light that a stretch takes, `albedo` is scattered and the rest absorbed, but for
// what `absorption_color` lets through.
//@ option sampling = quasi_cubic {linear, quasi_cubic, cubic} : interpolation of grids: quasi_cubic by a smoothstep-warped coordinate (Raseta et al., listing 1), cubic by a B-spline of eight taps
//@ option phase = hg {hg, schlick} : shape of a lobe: Henyey and Greenstein 1941, or the cheaper one of Blasi, Le Saec and Schlick 1993
//@ field float density : extinction (1/m); in mode paper density in 0..1
//@ field vec3 tint after density = {1, 1, 1} : factor of the albedo: smoke of several colours
//@ field vec3 radiance after density = {0, 0, 0} : light of the medium itself where it is opaque (in mode paper: its colour)
//@ field vec3 emission after density = {0, 0, 0} : light given off per metre, whatever the extinction
//@ field float temperature after density = 0 : of what glows as a black body (K)
//@ field float blackbody_intensity after density = 0 : how much of it glows: 1 is physical as in Blender, whose unit is the megawatt: 5.67e-14 T^4 / pi a metre
uniform vec3 extinction;           //= {1, 1, 1} [0, 1000] : factor of the density, by colour
uniform vec3 albedo;               //= {0.5, 0.5, 0.5} [0, 1] color : part of the light that is scattered, by colour
uniform vec3 absorption_color;     //= {0, 0, 0} [0, 1] color : what the light that is not scattered is dyed to; black: it is lost
uniform float anisotropy;          //= 0.2 [-0.95, 0.95] : g of the phase function: 0 all directions, above 0 forward
uniform vec4 lobe_weights;         //= {0, 0, 0, 0} [0, 1000] : of up to four lobes, of any sum; all 0: one lobe, of `anisotropy`. In Lua, lobes = { {2, 0.8}, {1, -0.3} } sets them and their g
uniform vec4 lobe_anisotropies;    //= {0, 0, 0, 0} [-0.95, 0.95] : g of each of them
uniform vec3 blackbody_tint;       //= {1, 1, 1} [0, 100] color : factor of a black body's light

#ifndef LIB_MEDIUM_GLSL
#define LIB_MEDIUM_GLSL
#include "fields.glsl"
#include "lib/blackbody.glsl"
#include "lib/phase.glsl"

// A pass whose colours are three lights (the option `rig` of lighting) takes the medium as grey, and
// without its own light.
#if defined(RIG) && RIG != RIG_NONE && RIG != RIG_OWN
#define MEDIUM_IS_GREY 1
vec3 medium_dyed(vec3 v) { return vec3((v.x + v.y + v.z) / 3.0); }
#else
#define MEDIUM_IS_GREY 0
vec3 medium_dyed(vec3 v) { return v; }
#endif

// Extinction of density 1, by colour.
vec3 medium_extinction() {
    return medium_dyed(extinction * (1.0 - (1.0 - albedo) * sqrt(absorption_color)));
}

// Scattering of density 1, by colour, before the tint.
vec3 medium_albedo() {
    return medium_dyed(extinction * albedo);
}

#ifndef WITHOUT_FIELDS
const float MEDIUM_MOST = 1e12; // of what a field may say: products of a few stay finite

// The field, where it is a number; below 0 there is nothing.
float medium_density(vec3 p) {
    float d = field_density(p);
    return d > 0.0 ? min(d, MEDIUM_MOST) : 0.0;
}

// What of it is scattering, at a point where the density is not 0.
vec3 medium_scattering(vec3 p) {
#if HAS_TINT
    return medium_dyed(extinction * albedo * clamp(field_tint(p), 0.0, 1.0));
#else
    return medium_albedo();
#endif
}

#if MEDIUM_IS_GREY
vec3 medium_emission(vec3 p, float d) { return vec3(0.0); }
#else
// Radiance given off per metre, W/m^3/sr, at a point where the density is d.
vec3 medium_emission(vec3 p, float d) {
    vec3 given = vec3(0.0);
#if HAS_EMISSION
    given += field_emission(p);
#endif
#if HAS_RADIANCE
    given += d * medium_extinction() * field_radiance(p);
#endif
#if HAS_TEMPERATURE && HAS_BLACKBODY_INTENSITY
    float intensity = field_blackbody_intensity(p);
    if (intensity > 0.0) given += intensity * blackbody_tint * blackbody_radiance(field_temperature(p));
#endif
    return mix(vec3(0.0), min(given, MEDIUM_MOST), greaterThan(given, vec3(0.0))); // of no number: 0
}
#endif
#endif

// Phase function (1/sr) of the cosine between the ways before and after; `spread` in 0..1 is a
// factor of every g.
float medium_phase(float cosine, float spread) {
    float total = dot(lobe_weights, vec4(1.0));
    if (total <= 0.0) return phase_lobe(cosine, anisotropy * spread);
    float sum = 0.0;
    for (int i = 0; i < 4; i++)
        if (lobe_weights[i] > 0.0)
            sum += lobe_weights[i] * phase_lobe(cosine, lobe_anisotropies[i] * spread);
    return sum / total;
}

// Mean cosine of scattering.
float medium_anisotropy() {
    float total = dot(lobe_weights, vec4(1.0));
    return total <= 0.0 ? anisotropy : dot(lobe_weights, lobe_anisotropies) / total;
}

#endif
