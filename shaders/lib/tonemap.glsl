// Tone mapping: scene-linear Rec.709 to display-linear Rec.709.

// The light that a display makes of values in 0..1 (IEC 61966-2-1, sRGB): who encodes it has them again.
vec3 tonemap_decode(vec3 v) {
    return mix(v / 12.92, pow((v + 0.055) / 1.055, vec3(2.4)), greaterThan(v, vec3(0.04045)));
}

vec3 tonemap_exponential(vec3 c) { return 1.0 - exp(-c); }

// Reinhard et al. 2002, on luminance, with white at 4.
vec3 tonemap_reinhard(vec3 c) {
    float l = max(dot(c, vec3(0.2126, 0.7152, 0.0722)), 1e-6);
    return c * ((1.0 + l / 16.0) / (1.0 + l));
}

// Fit of the ACES reference rendering and output transforms by Hill (2016).
vec3 tonemap_aces(vec3 c) {
    const mat3 to = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 from = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = to * c;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return from * v;
}

// AgX by Sobotka, with the polynomial fit of its base contrast by Wrensch (2023).
vec3 tonemap_agx(vec3 c) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float lowest = -12.47393, highest = 4.026069;
    vec3 x = clamp(log2(max(inset * c, 1e-10)), lowest, highest);
    x = (x - lowest) / (highest - lowest);
    vec3 x2 = x * x, x4 = x2 * x2;
    x = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    x = outset * x;
    return pow(max(x, 0.0), vec3(2.2)); // the fit is display-encoded
}
