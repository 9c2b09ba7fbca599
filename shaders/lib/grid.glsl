// Fetches from grids, as the shader's option SAMPLING says; without that option, linear.
#ifndef LIB_GRID_GLSL
#define LIB_GRID_GLSL

#ifndef SAMPLING
#define SAMPLING 0
#endif
#ifndef SAMPLING_QUASI_CUBIC
#define SAMPLING_QUASI_CUBIC -1
#endif
#ifndef SAMPLING_CUBIC
#define SAMPLING_CUBIC -2
#endif

// Width of what a sample stands for (m), for grids with levels. A shader may set it before it asks
// for a field; 0: the finest level.
float grid_width = 0.0;

float grid_level(float texels) { // that a sample is wide
    return log2(max(texels, 1.0));
}

vec4 grid_sample(sampler3D grid, vec3 uvw) {
#if SAMPLING == SAMPLING_QUASI_CUBIC
    // Quilez, "Improved texture interpolation": the coordinate is bent between texel centres by a
    // smoothstep, so that the linear filter has no visible kinks (Raseta et al., listing 1).
    vec3 size = vec3(textureSize(grid, 0)), at = uvw * size + 0.5;
    vec3 whole = floor(at), f = at - whole;
    return textureLod(grid, (whole + f * f * (3.0 - 2.0 * f) - 0.5) / size, 0.0);
#elif SAMPLING == SAMPLING_CUBIC
    // Cubic B-spline by eight linear fetches: Sigg and Hadwiger, "Fast third-order texture
    // filtering", GPU Gems 2, 2005.
    vec3 size = vec3(textureSize(grid, 0)), at = uvw * size - 0.5;
    vec3 whole = floor(at), f = at - whole, f2 = f * f, f3 = f2 * f;
    vec3 w0 = (1.0 - 3.0 * f + 3.0 * f2 - f3) / 6.0, w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
    vec3 w3 = f3 / 6.0, low = w0 + w1, high = 1.0 - low;
    vec3 a = (whole - 0.5 + w1 / low) / size, b = (whole + 1.5 + w3 / high) / size;
    vec4 near = mix(mix(textureLod(grid, vec3(b.x, b.y, a.z), 0.0),
                        textureLod(grid, vec3(a.x, b.y, a.z), 0.0), low.x),
                    mix(textureLod(grid, vec3(b.x, a.y, a.z), 0.0),
                        textureLod(grid, a, 0.0), low.x), low.y);
    vec4 far = mix(mix(textureLod(grid, b, 0.0),
                       textureLod(grid, vec3(a.x, b.y, b.z), 0.0), low.x),
                   mix(textureLod(grid, vec3(b.x, a.y, b.z), 0.0),
                       textureLod(grid, vec3(a.x, a.y, b.z), 0.0), low.x), low.y);
    return mix(near, far, high.z);
#else
    return textureLod(grid, uvw, 0.0);
#endif
}

#endif
