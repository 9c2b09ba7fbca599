// The light of the sky: a gradient from the horizon to the zenith, or a panorama, which
// src/scene/sky_image.h makes from a file.
#ifndef LIB_SKY_GLSL
#define LIB_SKY_GLSL
#include "lib/frame.glsl"
uniform sampler2D Sky;
uniform sampler2D SkyDistribution;

const float SKY_PI = 3.14159265;

// Known when a pass is compiled: a software device computes both sides of every branch.
#ifndef SKY_IMAGE
#define SKY_IMAGE int(frame.sky_zenith.w > 0.0)
#endif
bool sky_is_image() {
    return SKY_IMAGE == 1;
}

// Whether the sky has a night; over two colours the program has mixed it in already.
#ifndef SKY_NIGHT
#define SKY_NIGHT 1
#endif
vec3 sky_with_night(vec3 day, vec3 night) {
    return SKY_NIGHT == 1 ? mix(day, night, frame.night_zenith.w) : day;
}

// Of two colours: the radiance from a direction.
vec3 sky_gradient(vec3 zenith, vec3 horizon, float z) {
    return mix(horizon, zenith, sqrt(clamp(z, 0.0, 1.0)));
}

// Azimuth in the panorama, from its middle column to the right.
float sky_azimuth(vec3 direction) {
    return atan(direction.x, direction.y) + frame.sky_horizon.w;
}

// Radiance that comes from a direction (unit).
vec3 sky_radiance(vec3 direction) {
    if (!sky_is_image()) return sky_gradient(frame.sky_zenith.rgb, frame.sky_horizon.rgb, direction.z);
    float row = 0.5 / float(textureSize(Sky, 0).y); // the sampler repeats, which is wrong at the poles
    float v = clamp(acos(clamp(direction.z, -1.0, 1.0)) / SKY_PI, row, 1.0 - row);
    vec3 day = frame.sky_zenith.w * textureLod(Sky, vec2(0.5 + sky_azimuth(direction) / (2.0 * SKY_PI), v), 0.0).rgb;
    return sky_with_night(day, sky_gradient(frame.night_zenith.rgb, frame.night_horizon.rgb, direction.z));
}

// Coefficient of the panorama's light as SH polynomials, already spread by the cosine.
vec3 sky_coefficient(int index) {
    int row = textureSize(SkyDistribution, 0).y - 1;
    return vec3(texelFetch(SkyDistribution, ivec2(3 * index, row), 0).r,
                texelFetch(SkyDistribution, ivec2(3 * index + 1, row), 0).r,
                texelFetch(SkyDistribution, ivec2(3 * index + 2, row), 0).r);
}

// Irradiance of a surface of normal n (unit) over pi: what a white one sends back. Of a panorama by
// nine coefficients (Ramamoorthi and Hanrahan, "An efficient representation for irradiance
// environment maps", 2001); of the gradient by a fit that is within 0.005 of the integral.
vec3 sky_irradiance(vec3 n) {
    float zenith = 0.305 + n.z * (0.4 + 0.095 * n.z);
    if (!sky_is_image()) return mix(frame.sky_horizon.rgb, frame.sky_zenith.rgb, zenith);
    float c = cos(frame.sky_horizon.w), s = sin(frame.sky_horizon.w);
    vec3 m = vec3(n.x * c + n.y * s, n.y * c - n.x * s, n.z); // in the panorama
    vec3 sum = sky_coefficient(0) + m.y * sky_coefficient(1) + m.z * sky_coefficient(2) +
               m.x * sky_coefficient(3) + m.x * m.y * sky_coefficient(4) +
               m.y * m.z * sky_coefficient(5) + (3.0 * m.z * m.z - 1.0) * sky_coefficient(6) +
               m.x * m.z * sky_coefficient(7) + (m.x * m.x - m.y * m.y) * sky_coefficient(8);
    vec3 night = mix(frame.night_horizon.rgb, frame.night_zenith.rgb, zenith);
    return sky_with_night(frame.sky_zenith.w * max(sum, vec3(0.0)), night);
}

// Mean radiance of all directions.
vec3 sky_mean() {
    if (!sky_is_image()) return mix(frame.sky_horizon.rgb, frame.sky_zenith.rgb, 1.0 / 3.0);
    vec3 night = mix(frame.night_horizon.rgb, frame.night_zenith.rgb, 1.0 / 3.0);
    return sky_with_night(frame.sky_zenith.w * sky_coefficient(0), night);
}

// ---- drawing directions by their light ----------------------------------------------------------

// Cumulative share up to cell `at` of a row, or, with `rows`, up to row `at` of the table.
float sky_share(int at, int row, bool rows) {
    if (at < 0) return 0.0;
    int column = rows ? textureSize(SkyDistribution, 0).x - 1 : at;
    return texelFetch(SkyDistribution, ivec2(column, rows ? at : row), 0).r;
}

// The cell whose share holds `chosen`, which becomes how far into it that lies (0..1).
int sky_find(int count, int row, bool rows, inout float chosen) {
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (sky_share(middle, row, rows) > chosen) high = middle;
        else low = middle + 1;
    }
    float before = sky_share(low - 1, row, rows), after = sky_share(low, row, rows);
    chosen = after > before ? clamp((chosen - before) / (after - before), 0.0, 1.0) : 0.5;
    return low;
}

// Density (1/sr) of the directions of a cell.
float sky_cell_pdf(ivec2 cell, ivec2 cells) {
    float share = sky_share(cell.y, 0, true) - sky_share(cell.y - 1, 0, true);
    share *= sky_share(cell.x, cell.y, false) - sky_share(cell.x - 1, cell.y, false);
    float top = cos(SKY_PI * float(cell.y) / float(cells.y));
    float bottom = cos(SKY_PI * float(cell.y + 1) / float(cells.y));
    return share * float(cells.x) / (2.0 * SKY_PI * (top - bottom));
}

ivec2 sky_cells() {
    return textureSize(SkyDistribution, 0) - 1;
}

// Density (1/sr) with which sky_sample draws a direction (unit).
float sky_pdf(vec3 direction) {
    if (!sky_is_image()) return 0.25 / SKY_PI;
    ivec2 cells = sky_cells();
    float u = fract(0.5 + sky_azimuth(direction) / (2.0 * SKY_PI));
    float v = acos(clamp(direction.z, -1.0, 1.0)) / SKY_PI;
    return sky_cell_pdf(min(ivec2(vec2(u, v) * vec2(cells)), cells - 1), cells);
}

// A direction (unit) from two random numbers in 0..1.
vec3 sky_sample(vec2 random, out float pdf) {
    float azimuth = 2.0 * SKY_PI * random.x, z = 1.0 - 2.0 * random.y;
    pdf = 0.25 / SKY_PI;
    if (sky_is_image()) {
        ivec2 cells = sky_cells(), cell;
        cell.y = sky_find(cells.y, 0, true, random.y);
        cell.x = sky_find(cells.x, cell.y, false, random.x);
        pdf = sky_cell_pdf(cell, cells);
        azimuth = 2.0 * SKY_PI * ((float(cell.x) + random.x) / float(cells.x) - 0.5) - frame.sky_horizon.w;
        z = mix(cos(SKY_PI * float(cell.y) / float(cells.y)),
                cos(SKY_PI * float(cell.y + 1) / float(cells.y)), random.y);
    }
    float across = sqrt(max(1.0 - z * z, 0.0));
    return vec3(across * sin(azimuth), across * cos(azimuth), z);
}

#endif
