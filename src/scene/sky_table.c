// Means over parts of the sphere, and their sums.
#include "scene/sky_table.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// Returns the height (z) of the line between two rows on the unit sphere.
static double line_height(double row, uint32_t rows) {
    return cos(pi * row / rows);
}

// Each of the `wanted` texels becomes the mean of the `count` texels that it covers.
static void resize_row(const float *from, uint32_t count, float *to, uint32_t wanted) {
    for (uint32_t x = 0; x < wanted; x++) {
        double begin = (double)x * count / wanted, end = (double)(x + 1) * count / wanted;
        double sum[3] = {0};
        for (uint32_t s = (uint32_t)begin; s < count && s < end; s++) {
            double part = fmin(end, s + 1.0) - fmax(begin, s);
            for (int c = 0; c < 3; c++) sum[c] += part * (double)from[3 * s + (uint32_t)c];
        }
        for (int c = 0; c < 3; c++) to[3 * x + (uint32_t)c] = (float)(sum[c] / (end - begin));
    }
}

// Adds the rows between two lines of the picture, weighted by their area on the sphere.
static void resize_column(const panorama *from, double begin, double end, float *to) {
    size_t width = 3 * (size_t)from->width;
    double whole = line_height(begin, from->height) - line_height(end, from->height);
    for (uint32_t s = (uint32_t)begin; s < from->height && s < end; s++) {
        double part = line_height(fmax(begin, s), from->height) -
                      line_height(fmin(end, s + 1.0), from->height);
        float weight = (float)(part / whole);
        const float *row = from->rgb + s * width;
        for (size_t i = 0; i < width; i++) to[i] += weight * row[i];
    }
}

panorama panorama_resize(const panorama *from, uint32_t width, uint32_t height, arena *memory) {
    panorama narrow = {width, from->height, NULL}, out = {width, height, NULL};
    size_t row = 3 * (size_t)width;
    narrow.rgb = mem_alloc(row * from->height * sizeof(float));
    for (uint32_t y = 0; y < from->height; y++)
        resize_row(from->rgb + 3 * (size_t)y * from->width, from->width, narrow.rgb + y * row,
                   width);
    out.rgb = arena_alloc(memory, row * height * sizeof(float));
    for (uint32_t y = 0; y < height; y++)
        resize_column(&narrow, (double)y * from->height / height,
                      (double)(y + 1) * from->height / height, out.rgb + y * row);
    mem_free(narrow.rgb);
    return out;
}

// ---- cumulative shares --------------------------------------------------------------------------

// The texture's filter spreads light into dark cells, which must be sampled too, so each cell has
// at least this part of the mean.
static const double least_share = 0.05;

static double luminance(const float rgb[3]) {
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static double row_area(uint32_t y) { // of a cell, in parts of the sphere
    return (line_height(y, SKY_CELLS_Y) - line_height(y + 1, SKY_CELLS_Y)) / (2 * SKY_CELLS_X);
}

static double mean_luminance(const panorama *cells) {
    double sum = 0;
    for (uint32_t y = 0; y < SKY_CELLS_Y; y++)
        for (uint32_t x = 0; x < SKY_CELLS_X; x++)
            sum += row_area(y) * luminance(&cells->rgb[3 * (y * SKY_CELLS_X + x)]);
    return sum;
}

// Returns the light of the row.
static double fill_row(const panorama *cells, uint32_t y, double least, float out[SKY_TABLE_X]) {
    double sums[SKY_CELLS_X], sum = 0;
    for (uint32_t x = 0; x < SKY_CELLS_X; x++)
        sums[x] = sum += least + luminance(&cells->rgb[3 * (y * SKY_CELLS_X + x)]);
    for (uint32_t x = 0; x < SKY_CELLS_X; x++) out[x] = (float)(sums[x] / sum);
    return sum * row_area(y);
}

static void fill_shares(const panorama *cells, sky_table *out) {
    double least = least_share * mean_luminance(cells), sums[SKY_CELLS_Y], sum = 0;
    for (uint32_t y = 0; y < SKY_CELLS_Y; y++)
        sums[y] = sum += fill_row(cells, y, least, out->values[y]);
    for (uint32_t y = 0; y < SKY_CELLS_Y; y++) out->values[y][SKY_CELLS_X] = (float)(sums[y] / sum);
}

// ---- light as polynomials -----------------------------------------------------------------------

// Returns the direction of the middle of a cell. The middle column is +Y.
static void cell_direction(uint32_t x, uint32_t y, double out[3]) {
    double azimuth = 2 * pi * ((x + 0.5) / SKY_CELLS_X - 0.5);
    double z = (line_height(y, SKY_CELLS_Y) + line_height(y + 1, SKY_CELLS_Y)) / 2;
    double across = sqrt(1 - z * z);
    out[0] = across * sin(azimuth);
    out[1] = across * cos(azimuth);
    out[2] = z;
}

static void polynomials(const double d[3], double out[9]) {
    const double values[9] = {1,
                              d[1],
                              d[2],
                              d[0],
                              d[0] * d[1],
                              d[1] * d[2],
                              3 * d[2] * d[2] - 1,
                              d[0] * d[2],
                              d[0] * d[0] - d[1] * d[1]};
    memcpy(out, values, sizeof values);
}

// Computes nine coefficients for each colour: of the spherical harmonics up to degree 2, times the
// factor of each for light that is spread by the cosine (Ramamoorthi and Hanrahan 2001, equations 8
// and 12, over pi), including the normalisation of both.
static void fill_polynomials(const panorama *cells, float *out) {
    static const double factors[9] = {
        1 / (4 * pi),           2.0 / 3 * 3 / (4 * pi), 2.0 / 3 * 3 / (4 * pi),
        2.0 / 3 * 3 / (4 * pi), 0.25 * 15 / (4 * pi),   0.25 * 15 / (4 * pi),
        0.25 * 5 / (16 * pi),   0.25 * 15 / (4 * pi),   0.25 * 15 / (16 * pi)};
    double sums[9][3] = {0};
    for (uint32_t y = 0; y < SKY_CELLS_Y; y++)
        for (uint32_t x = 0; x < SKY_CELLS_X; x++) {
            double direction[3], values[9];
            cell_direction(x, y, direction);
            polynomials(direction, values);
            for (int i = 0; i < 9; i++)
                for (int c = 0; c < 3; c++)
                    sums[i][c] += 4 * pi * row_area(y) * values[i] *
                                  (double)cells->rgb[3 * (y * SKY_CELLS_X + x) + (uint32_t)c];
        }
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++) out[3 * i + c] = (float)(factors[i] * sums[i][c]);
}

// Returns the mean of the rows from `begin` to `end`.
static void mean_of_rows(const panorama *cells, uint32_t begin, uint32_t end, float out[3]) {
    double sum[3] = {0}, area = 0;
    for (uint32_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < SKY_CELLS_X; x++) {
            area += row_area(y);
            for (int c = 0; c < 3; c++)
                sum[c] += row_area(y) * (double)cells->rgb[3 * (y * SKY_CELLS_X + x) + (uint32_t)c];
        }
    for (int c = 0; c < 3; c++) out[c] = (float)(sum[c] / area);
}

void sky_table_fill(const panorama *image, sky_table *out) {
    arena memory = {0};
    panorama cells = panorama_resize(image, SKY_CELLS_X, SKY_CELLS_Y, &memory);
    fill_shares(&cells, out);
    fill_polynomials(&cells, out->values[SKY_CELLS_Y]);
    mean_of_rows(&cells, 0, SKY_CELLS_Y / 4, out->zenith);                     // within 45 degrees
    mean_of_rows(&cells, SKY_CELLS_Y * 7 / 16, SKY_CELLS_Y / 2, out->horizon); // 0 to 11 degrees
    arena_free(&memory);
}
