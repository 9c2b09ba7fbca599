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
#ifndef SAMPLING_NEAREST
#define SAMPLING_NEAREST -3
#endif

// Width of what a sample stands for (m), for grids with levels. A shader may set it before it asks
// for a field; 0: the finest level.
float grid_width = 0.0;

float grid_level(float texels) { // that a sample is wide
    return log2(max(texels, 1.0));
}

#if SAMPLING == SAMPLING_QUASI_CUBIC
// Quilez, "Improved texture interpolation": the coordinate (in texels) is bent between texel centres
// by a smoothstep, so that the linear filter has no visible kinks (Raseta et al., listing 1).
vec3 grid_bend(vec3 at) {
    vec3 whole = floor(at + 0.5), f = at + 0.5 - whole;
    return whole + f * f * (3.0 - 2.0 * f) - 0.5;
}
#elif SAMPLING == SAMPLING_CUBIC
// Cubic B-spline by eight linear fetches: Sigg and Hadwiger, "Fast third-order texture filtering",
// GPU Gems 2, 2005. They lie at the corners of the box from a to b (in texels); `low` is the share
// of a's sides.
void grid_spline(vec3 at, out vec3 a, out vec3 b, out vec3 low) {
    vec3 whole = floor(at - 0.5), f = at - 0.5 - whole, f2 = f * f, f3 = f2 * f;
    vec3 w0 = (1.0 - 3.0 * f + 3.0 * f2 - f3) / 6.0, w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
    vec3 w3 = f3 / 6.0;
    low = w0 + w1;
    a = whole - 0.5 + w1 / low;
    b = whole + 1.5 + w3 / (1.0 - low);
}
#endif

vec4 grid_sample(sampler3D grid, vec3 uvw) {
#if SAMPLING == SAMPLING_QUASI_CUBIC
    vec3 size = vec3(textureSize(grid, 0));
    return textureLod(grid, grid_bend(uvw * size) / size, 0.0);
#elif SAMPLING == SAMPLING_CUBIC
    vec3 size = vec3(textureSize(grid, 0)), a, b, low;
    grid_spline(uvw * size, a, b, low);
    a /= size;
    b /= size;
    vec4 near = mix(mix(textureLod(grid, vec3(b.x, b.y, a.z), 0.0),
                        textureLod(grid, vec3(a.x, b.y, a.z), 0.0), low.x),
                    mix(textureLod(grid, vec3(b.x, a.y, a.z), 0.0),
                        textureLod(grid, a, 0.0), low.x), low.y);
    vec4 far = mix(mix(textureLod(grid, b, 0.0),
                       textureLod(grid, vec3(a.x, b.y, b.z), 0.0), low.x),
                   mix(textureLod(grid, vec3(b.x, a.y, b.z), 0.0),
                       textureLod(grid, vec3(a.x, a.y, b.z), 0.0), low.x), low.y);
    return mix(near, far, 1.0 - low.z);
#elif SAMPLING == SAMPLING_NEAREST
    ivec3 size = textureSize(grid, 0);
    return texelFetch(grid, clamp(ivec3(uvw * vec3(size)), ivec3(0), size - 1), 0);
#else
    return textureLod(grid, uvw, 0.0);
#endif
}

// ---- sparse grids -----------------------------------------------------------------------------

// A brick of 8^3 texels lies in the atlas with the sides of its neighbours that linear filtering
// reaches, 9^3. The index says where: ten bits for each axis, or 0 for a brick of zeros
// (field/sequence_sparse.c). `at` is in texels of the whole grid, `size`.
vec4 grid_brick(sampler3D atlas, usampler3D index, vec3 size, vec3 at) {
    vec3 from = clamp(at - 0.5, vec3(0.0), size - 1.0);
    ivec3 brick = ivec3(from) >> 3;
    uint place = texelFetch(index, brick, 0).r;
    if (place == 0u) return vec4(0.0);
    vec3 corner = vec3(place & 1023u, (place >> 10) & 1023u, (place >> 20) & 1023u) * 9.0 + 0.5;
    return textureLod(atlas, (corner + (from - vec3(brick << 3))) / vec3(textureSize(atlas, 0)),
                      0.0);
}

vec4 grid_sample_bricks(sampler3D atlas, usampler3D index, vec3 size, vec3 uvw) {
#if SAMPLING == SAMPLING_QUASI_CUBIC
    return grid_brick(atlas, index, size, grid_bend(uvw * size));
#elif SAMPLING == SAMPLING_CUBIC
    vec3 a, b, low;
    grid_spline(uvw * size, a, b, low);
    vec4 near = mix(mix(grid_brick(atlas, index, size, vec3(b.x, b.y, a.z)),
                        grid_brick(atlas, index, size, vec3(a.x, b.y, a.z)), low.x),
                    mix(grid_brick(atlas, index, size, vec3(b.x, a.y, a.z)),
                        grid_brick(atlas, index, size, a), low.x), low.y);
    vec4 far = mix(mix(grid_brick(atlas, index, size, b),
                       grid_brick(atlas, index, size, vec3(a.x, b.y, b.z)), low.x),
                   mix(grid_brick(atlas, index, size, vec3(b.x, a.y, b.z)),
                       grid_brick(atlas, index, size, vec3(a.x, a.y, b.z)), low.x), low.y);
    return mix(near, far, 1.0 - low.z);
#elif SAMPLING == SAMPLING_NEAREST
    return grid_brick(atlas, index, size, floor(uvw * size) + 0.5);
#else
    return grid_brick(atlas, index, size, uvw * size);
#endif
}

#endif
