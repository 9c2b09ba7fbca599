// What a surface sends back of the light that meets it, by the option `model`.
//
//     shaded s = shading_of(p, n, view, base, surface);  // of what `geometry` gives
//     color += shading_reflect(s, to_light, irradiance);
//
// Light from many places is best added up as `reflected`, which minds the surface's colour once.
//@ option model = physical {physical, lambert, blinn_phong, toon} : what surfaces make of light: physical: Lambert and GGX, by the material; lambert: diffuse only; blinn_phong: with a highlight as published in 1977, which keeps no energy; toon: that in bands
uniform int toon_levels; //= 4 [1, 32] : bands of light, of model toon

#ifndef LIB_SHADING_GLSL
#define LIB_SHADING_GLSL

const float SHADING_PI = 3.14159265;
const float SHADING_SHARPEST = 0.1; // roughness: a point's highlight would be smaller than a pixel below

struct shaded {
    vec3 position, normal, view; // view: unit, towards the camera
    vec3 base;
    float specular, roughness, metallic;
    bool toon;
};

// `surface`: specular, roughness, metallic, and 1 where toon shading is allowed.
shaded shading_of(vec3 position, vec3 normal, vec3 view, vec3 base, vec4 surface) {
    return shaded(position, normal, view, base, surface.x, surface.y, surface.z, surface.w > 0.5);
}

struct reflected {
    vec3 white; // irradiance over pi, of which the surface sends back what is of its colour
    vec3 shine; // radiance beside that: highlights
};

bool shading_is_physical(shaded s) {
#if MODEL == MODEL_PHYSICAL
    return true;
#elif MODEL == MODEL_TOON
    return !s.toon;
#else
    return false;
#endif
}

bool shading_is_toon(shaded s) {
    return MODEL == MODEL_TOON && s.toon;
}

// ---- physical ---------------------------------------------------------------------------------

// Reflectance of what light meets head on: 4 percent at `specular` 0.5, as of glass and most
// plastics (Burley, "Physically based shading at Disney", 2012); of a metal its colour.
vec3 shading_straight(shaded s) {
    return mix(vec3(0.08 * s.specular), s.base, s.metallic);
}

// Of what it meets along the surface. What hardly reflects does not do so there either (Lagarde and
// de Rousiers, "Moving Frostbite to physically based rendering", 2014, section 3.1.3).
float shading_grazing(vec3 straight) {
    return min(50.0 * max(straight.r, max(straight.g, straight.b)), 1.0);
}

// Part of even light from all sides that is mirrored towards the viewer. Not less than that of GGX
// (within 0.004, by integration over roughness and angle), so that no light is sent back twice; of
// rough metal more, as if light were scattered between its facets.
vec3 shading_mirrored(shaded s) {
    vec3 straight = shading_straight(s);
    float away = 1.0 - clamp(dot(s.normal, s.view), 0.0, 1.0), square = away * away;
    float rough = s.roughness * s.roughness;
    float rim = square * square * away / (1.0 + 20.5 * rough * rough);
    return straight + max(shading_grazing(straight) - straight, vec3(0.0)) * rim;
}

// GGX with the height-correlated shadowing of Smith (Heitz, "Understanding the masking-shadowing
// function in microfacet-based BRDFs", JCGT 3(2), 2014) and Schlick's Fresnel, times the cosine.
vec3 shading_ggx(shaded s, vec3 to_light, float cosine) {
    vec3 middle = normalize(to_light + s.view), straight = shading_straight(s);
    float rough = max(s.roughness, SHADING_SHARPEST), a = rough * rough, a2 = a * a;
    float seen = max(dot(s.normal, s.view), 1e-3);
    float up = clamp(dot(s.normal, middle), 0.0, 1.0), way = clamp(dot(s.view, middle), 0.0, 1.0);
    float peak = 1.0 + up * up * (a2 - 1.0);
    float facets = a2 / (SHADING_PI * peak * peak);
    float hidden = 0.5 / (cosine * sqrt(seen * seen * (1.0 - a2) + a2) + seen * sqrt(cosine * cosine * (1.0 - a2) + a2));
    float rim = pow(1.0 - way, 5.0);
    return (straight + max(shading_grazing(straight) - straight, vec3(0.0)) * rim) * (facets * hidden * cosine);
}

// ---- published --------------------------------------------------------------------------------

// Blinn, "Models of light reflection for computer synthesized pictures", 1977: without a unit.
float shading_highlight(shaded s, vec3 to_light) {
    float rough = max(s.roughness, SHADING_SHARPEST), a = rough * rough;
    return pow(max(dot(s.normal, normalize(to_light + s.view)), 0.0), max(2.0 / (a * a) - 2.0, 1.0));
}

// The middle of the band that a share of light is in.
float shading_band(float share) {
    float levels = float(toon_levels);
    return (min(floor(share * levels), levels - 1.0) + 0.5) / levels;
}

// ---- all --------------------------------------------------------------------------------------

// What `white` is multiplied by.
vec3 shading_color(shaded s) {
    if (!shading_is_physical(s)) return s.base;
    return s.base * (1.0 - s.metallic) * (1.0 - shading_mirrored(s));
}

// Of light from one direction, of this irradiance where it meets a surface head on (W/m^2).
reflected shading_respond(shaded s, vec3 to_light, vec3 irradiance) {
    float cosine = max(dot(s.normal, to_light), 0.0);
    reflected r = reflected(irradiance * (cosine / SHADING_PI), vec3(0.0));
#if MODEL == MODEL_BLINN_PHONG || MODEL == MODEL_TOON
    if (!shading_is_physical(s)) {
        if (cosine <= 0.0) return r; // so that of toon what faces away stays dark
        float highlight = shading_highlight(s, to_light);
        if (shading_is_toon(s)) {
            r.white = irradiance * (shading_band(cosine) / SHADING_PI);
            highlight = shading_band(highlight);
        }
        r.shine = irradiance * (s.specular * highlight / SHADING_PI);
        return r;
    }
#endif
#if MODEL == MODEL_PHYSICAL || MODEL == MODEL_TOON
    if (cosine > 0.0 && s.specular + s.metallic > 0.0) r.shine = irradiance * shading_ggx(s, to_light, cosine);
#endif
    return r;
}

void shading_add(inout reflected sum, reflected more) {
    sum.white += more.white;
    sum.shine += more.shine;
}

void shading_dim(inout reflected r, vec3 part) {
    r.white *= part;
    r.shine *= part;
}

// Radiance towards the viewer.
vec3 shading_total(shaded s, reflected sum) {
    return shading_color(s) * sum.white + sum.shine;
}

vec3 shading_reflect(shaded s, vec3 to_light, vec3 irradiance) {
    return shading_total(s, shading_respond(s, to_light, irradiance));
}

#endif
