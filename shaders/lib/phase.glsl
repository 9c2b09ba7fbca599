// Phase functions: how scattered light is spread over directions (1/sr; the integral is 1).
#ifndef LIB_PHASE_GLSL
#define LIB_PHASE_GLSL

// Henyey and Greenstein, "Diffuse radiation in the galaxy", 1941.
float phase_hg(float cosine, float g) {
    float base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (12.5663706 * base * sqrt(base));
}

// Blasi, Le Saec and Schlick, "A rendering algorithm for discrete volume density objects", 1993,
// with the k that comes nearest to Henyey and Greenstein's g.
float phase_schlick(float cosine, float g) {
    float k = 1.55 * g - 0.55 * g * g * g, base = 1.0 - k * cosine;
    return (1.0 - k * k) / (12.5663706 * base * base);
}

// As the option PHASE says.
float phase_lobe(float cosine, float g) {
#if defined(PHASE_SCHLICK) && PHASE == PHASE_SCHLICK
    return phase_schlick(cosine, g);
#else
    return phase_hg(cosine, g);
#endif
}

#endif
