// Light of a black body.
#ifndef LIB_BLACKBODY_GLSL
#define LIB_BLACKBODY_GLSL

// Radiance in W/m^2/sr times 1e-6, of a body that glows at so many kelvin: Stefan and Boltzmann's
// law, as a colour of that luminance. The colour is that of palettes (src/field/color.c: Planck's
// law against the CIE 1931 observer, in Rec.709), to within 0.0015 from 800 to 12000 K by a fit of
// ours to it, rational in 1/T. Below and above it is that at the end of this range.
vec3 blackbody_radiance(float kelvin) {
    float u = clamp(1000.0 / max(kelvin, 1.0), 1.0 / 12.0, 1.25), u2 = u * u, u3 = u2 * u;
    vec3 above = vec3(0.66948414, 0.95029505, 2.3054116) + vec3(2.2787126, 2.3018023, -5.9040296) * u +
                 vec3(14.365518, -4.3727320, 3.3763644) * u2 + vec3(-5.6012482, 1.4697121, -0.94053706) * u3;
    vec3 below = 1.0 + vec3(1.8739444, 1.4040314, 1.2430249) * u + vec3(-0.16295906, 0.41556189, 9.8390775) * u2;
    vec3 color = max(above / below, 0.0); // deep reds leave the gamut
    float square = max(kelvin, 0.0) * max(kelvin, 0.0);
    return color / dot(color, vec3(0.2126, 0.7152, 0.0722)) * (1.8049358e-14 * square * square);
}

#endif
