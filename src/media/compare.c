// PSNR, SSIM and LDR-FLIP of two pictures.
#include "media/compare.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/worker.h"
#include <assert.h>
#include <math.h>
#include <string.h>

static size_t pixels_of(const compare_picture *p) {
    return (size_t)p->width * p->height;
}

// ---- over all cores ---------------------------------------------------------------------------

// Handles rows (or columns, or pixels) `first` up to `end`. Each is handled by itself, so that the
// result does not depend on how they are divided among threads.
typedef void stretch(void *user, size_t first, size_t end);

typedef struct stretches {
    stretch *run;
    void *user;
    size_t count, each;
} stretches;

static bool run_stretch(void *user, size_t index) {
    const stretches *p = user;
    size_t first = index * p->each, end = first + p->each;
    p->run(p->user, first, end < p->count ? end : p->count);
    return true;
}

static void share_out(size_t count, size_t each, stretch *run, void *user) {
    stretches p = {run, user, count, each};
    worker_each((count + each - 1) / each, run_stretch, &p);
}

enum { ROWS_EACH = 16, COLUMNS_EACH = 64, PIXELS_EACH = 65536 };

// ---- separable filters ------------------------------------------------------------------------

typedef struct kernel { // 2 * radius + 1 weights
    int radius;
    float *weights;
} kernel;

static kernel make_kernel(int radius) {
    return (kernel){radius, mem_alloc((size_t)(2 * radius + 1) * sizeof(float))};
}

// Samples exp(-falloff * x * x) at integers and normalises the sum to 1. `*sum` receives the sum
// before that.
static kernel make_gaussian(int radius, double falloff, double *sum) {
    kernel k = make_kernel(radius);
    *sum = 0;
    for (int x = -radius; x <= radius; x++) *sum += exp(-falloff * x * x);
    for (int x = -radius; x <= radius; x++)
        k.weights[x + radius] = (float)(exp(-falloff * x * x) / *sum);
    return k;
}

// Filters one line; its ends are repeated beyond it. `padded` has room for count + 2 * radius.
static void filter_line(const kernel *k, const float *line, size_t count, size_t stride,
                        float *padded, float *out) {
    size_t radius = (size_t)k->radius;
    for (size_t i = 0; i < count + 2 * radius; i++) {
        size_t at = i < radius ? 0 : i - radius;
        padded[i] = line[(at < count ? at : count - 1) * stride];
    }
    for (size_t i = 0; i < count; i++) {
        float sum = 0;
        for (size_t t = 0; t < 2 * radius + 1; t++) sum += k->weights[t] * padded[i + t];
        out[i * stride] = sum;
    }
}

typedef struct filtering {
    size_t width, height, margin;
    const kernel *across, *down;
    const float *in;
    float *out;
} filtering;

static void filter_rows(void *user, size_t first, size_t end) {
    const filtering *f = user;
    float *padded = mem_alloc((f->width + f->margin) * sizeof *padded);
    for (size_t y = first; y < end; y++)
        filter_line(f->across, f->in + y * f->width, f->width, 1, padded, f->out + y * f->width);
    mem_free(padded);
}

static void filter_columns(void *user, size_t first, size_t end) {
    const filtering *f = user;
    float *padded = mem_alloc((f->height + f->margin) * sizeof *padded);
    for (size_t x = first; x < end; x++)
        filter_line(f->down, f->out + x, f->height, f->width, padded, f->out + x);
    mem_free(padded);
}

// Filters by `across` along rows, then by `down` along columns. `out` may be `in`.
static void filter_rows_columns(const compare_picture *shape, const kernel *across,
                                const kernel *down, const float *in, float *out) {
    size_t margin = 2 * (size_t)(across->radius > down->radius ? across->radius : down->radius);
    filtering f = {shape->width, shape->height, margin, across, down, in, out};
    share_out(f.height, ROWS_EACH, filter_rows, &f);
    share_out(f.width, COLUMNS_EACH, filter_columns, &f);
}

// ---- PSNR -------------------------------------------------------------------------------------

double compare_psnr(const compare_picture *a, const compare_picture *b) {
    assert(a->width == b->width && a->height == b->height);
    size_t count = pixels_of(a) * 3;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double d = (double)a->rgb[i] - (double)b->rgb[i];
        sum += d * d;
    }
    return sum > 0 ? -10 * log10(sum / (double)count) : (double)INFINITY;
}

// ---- SSIM -------------------------------------------------------------------------------------

enum { SSIM_RADIUS = 5 };

static double luma(const float *rgb) {
    return 0.299 * (double)rgb[0] + 0.587 * (double)rgb[1] + 0.114 * (double)rgb[2];
}

// Means of luma and its products around each pixel.
enum { MEAN_A, MEAN_B, MEAN_AA, MEAN_BB, MEAN_AB, MEAN_COUNT };

static float *make_means(const compare_picture *a, const compare_picture *b) {
    size_t count = pixels_of(a);
    float *means = mem_alloc(count * MEAN_COUNT * sizeof *means);
    for (size_t i = 0; i < count; i++) {
        float u = (float)luma(a->rgb + i * 3), v = (float)luma(b->rgb + i * 3);
        const float values[MEAN_COUNT] = {u, v, u * u, v * v, u * v};
        for (size_t m = 0; m < MEAN_COUNT; m++) means[m * count + i] = values[m];
    }
    double sum;
    kernel k = make_gaussian(SSIM_RADIUS, 1 / (2 * 1.5 * 1.5), &sum);
    for (size_t m = 0; m < MEAN_COUNT; m++)
        filter_rows_columns(a, &k, &k, means + m * count, means + m * count);
    mem_free(k.weights);
    return means;
}

// Equation 13 at a pixel. `means` are as in make_means, `count` apart.
static double similarity(const float *means, size_t count) {
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double u = (double)means[MEAN_A * count], v = (double)means[MEAN_B * count];
    double variances =
        (double)means[MEAN_AA * count] - u * u + (double)means[MEAN_BB * count] - v * v;
    double covariance = (double)means[MEAN_AB * count] - u * v;
    return (2 * u * v + c1) * (2 * covariance + c2) / ((u * u + v * v + c1) * (variances + c2));
}

double compare_ssim(const compare_picture *a, const compare_picture *b) {
    assert(a->width == b->width && a->height == b->height);
    size_t width = a->width, height = a->height, count = pixels_of(a);
    size_t left = width > 2 * SSIM_RADIUS ? SSIM_RADIUS : 0;
    size_t top = height > 2 * SSIM_RADIUS ? SSIM_RADIUS : 0;
    float *means = make_means(a, b);
    double sum = 0;
    for (size_t y = top; y < height - top; y++)
        for (size_t x = left; x < width - left; x++)
            sum += similarity(means + y * width + x, count);
    mem_free(means);
    return sum / ((double)(width - 2 * left) * (double)(height - 2 * top));
}

// ---- FLIP: colour, section 4.1 ----------------------------------------------------------------

typedef struct color {
    double x, y, z; // of the space that its user names
} color;

static const double srgb_to_xyz[3][3] = {{0.41238656, 0.35759149, 0.18045049},
                                         {0.21263682, 0.71518298, 0.07218020},
                                         {0.01933062, 0.11919716, 0.95037259}};
static const double xyz_to_srgb[3][3] = {{3.24100326, -1.53739899, -0.49861587},
                                         {-0.96922426, 1.87592999, 0.04155422},
                                         {0.05563942, -0.20401120, 1.05714897}};

static color color_transform(const double m[3][3], color c) {
    return (color){m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z,
                   m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
                   m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
}

static double decode_srgb(double v) {
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

// Converts linear RGB to XYZ relative to white.
static color relative_xyz(color rgb) {
    color c = color_transform(srgb_to_xyz, rgb),
          white = color_transform(srgb_to_xyz, (color){1, 1, 1});
    return (color){c.x / white.x, c.y / white.y, c.z / white.z};
}

// Converts to the opponent space in which the contrast sensitivity of the eye is known.
static color ycxcz(const float *rgb) {
    color c = relative_xyz((color){decode_srgb((double)rgb[0]), decode_srgb((double)rgb[1]),
                                   decode_srgb((double)rgb[2])});
    return (color){116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

static double clamp01(double v) {
    return v < 0 ? 0 : v > 1 ? 1 : v;
}

static color rgb_of_ycxcz(color c) {
    color white = color_transform(srgb_to_xyz, (color){1, 1, 1});
    double y = (c.x + 16) / 116;
    color rgb = color_transform(
        xyz_to_srgb, (color){(y + c.y / 500) * white.x, y * white.y, (y - c.z / 200) * white.z});
    return (color){clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)};
}

static double lab_curve(double t) {
    const double d = 6.0 / 29;
    return t > d * d * d ? cbrt(t) : t / (3 * d * d) + 4.0 / 29;
}

// Converts to CIELab with the Hunt adjustment: dark colours look less colourful.
static color hunt_lab(color rgb) {
    color c = relative_xyz(rgb);
    double x = lab_curve(c.x), y = lab_curve(c.y), z = lab_curve(c.z), l = 116 * y - 16;
    return (color){l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

// Returns the HyAB distance to the power that compresses large distances.
static double color_distance(color a, color b) {
    return pow(fabs(a.x - b.x) + hypot(a.y - b.y, a.z - b.z), 0.7);
}

// Maps a distance to 0 to 1. Distances up to 0.4 of `greatest` get 0.95 of the range.
static double redistribute(double distance, double greatest) {
    double knee = 0.4 * greatest;
    return distance < knee ? 0.95 / knee * distance
                           : 0.95 + (distance - knee) / (greatest - knee) * 0.05;
}

// Filters by the sum of two Gaussians exp(-pi^2 z / b), weighted by a * sqrt(pi / b); z is in
// degrees squared.
static void filter_by_sensitivity(const compare_picture *shape, double ppd, const double a[2],
                                  const double b[2], float *plane) {
    size_t count = pixels_of(shape);
    int radius = (int)ceil(3 * sqrt(0.04 / (2 * M_PI * M_PI)) * ppd); // of the widest channel
    float *sum = mem_alloc(count * sizeof *sum), *part = mem_alloc(count * sizeof *part);
    double total = 0;
    for (size_t g = 0; g < 2 && a[g] > 0; g++) {
        double line;
        kernel k = make_gaussian(radius, M_PI * M_PI / (b[g] * ppd * ppd), &line);
        double weight = a[g] * sqrt(M_PI / b[g]) * line * line;
        filter_rows_columns(shape, &k, &k, plane, part);
        for (size_t i = 0; i < count; i++) sum[i] += (float)weight * part[i];
        total += weight;
        mem_free(k.weights);
    }
    for (size_t i = 0; i < count; i++) plane[i] = sum[i] / (float)total;
    mem_free(part);
    mem_free(sum);
}

typedef struct conversion {
    const float *rgb;
    float *planes;
    size_t count;
} conversion;

static void convert_rows(void *user, size_t first, size_t end) {
    const conversion *v = user;
    for (size_t i = first; i < end; i++) {
        color c = ycxcz(v->rgb + i * 3);
        v->planes[i] = (float)c.x;
        v->planes[v->count + i] = (float)c.y;
        v->planes[2 * v->count + i] = (float)c.z;
    }
}

// Returns three planes of YCxCz as an eye at that distance resolves them.
static float *make_seen(const compare_picture *p, double ppd) {
    static const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
    static const double b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    size_t count = pixels_of(p);
    float *planes = mem_alloc(count * 3 * sizeof *planes);
    share_out(count, PIXELS_EACH, convert_rows, &(conversion){p->rgb, planes, count});
    for (size_t c = 0; c < 3; c++) filter_by_sensitivity(p, ppd, a[c], b[c], planes + c * count);
    return planes;
}

static color seen_lab(const float *planes, size_t count, size_t i) {
    return hunt_lab(rgb_of_ycxcz(
        (color){(double)planes[i], (double)planes[count + i], (double)planes[2 * count + i]}));
}

typedef struct seen {
    const float *a, *b; // planes
    float *map;
    size_t count;
    double greatest;
} seen;

static void compare_seen(void *user, size_t first, size_t end) {
    const seen *s = user;
    for (size_t i = first; i < end; i++) {
        double d = color_distance(seen_lab(s->a, s->count, i), seen_lab(s->b, s->count, i));
        s->map[i] = (float)redistribute(d, s->greatest);
    }
}

static void color_errors(const compare_picture *a, const compare_picture *b, double ppd,
                         float *map) {
    size_t count = pixels_of(a);
    float *seen_a = make_seen(a, ppd), *seen_b = make_seen(b, ppd);
    double greatest = color_distance(hunt_lab((color){0, 1, 0}), hunt_lab((color){0, 0, 1}));
    share_out(count, PIXELS_EACH, compare_seen, &(seen){seen_a, seen_b, map, count, greatest});
    mem_free(seen_b);
    mem_free(seen_a);
}

// ---- FLIP: features, section 4.2 --------------------------------------------------------------

// Samples the first or second derivative of a Gaussian. Its positive weights sum to 1, its negative
// ones to -1.
static kernel make_derivative(int radius, double sigma, bool second) {
    kernel k = make_kernel(radius);
    double sums[2] = {0, 0};
    for (int pass = 0; pass < 2; pass++)
        for (int x = -radius; x <= radius; x++) {
            double at = x / sigma, slope = second ? at * at - 1 : -at;
            double weight = slope * exp(-0.5 * at * at);
            if (pass == 0)
                sums[weight > 0] += fabs(weight);
            else
                k.weights[x + radius] = (float)(weight / sums[weight > 0]);
        }
    return k;
}

// Finds the strength of edges (or, with `second`, of points) at each pixel.
static void find_features(const compare_picture *p, const float *plane, double ppd, bool second,
                          float *out) {
    size_t count = pixels_of(p);
    double sigma = 0.5 * 0.082 * ppd, sum; // 0.082 degrees: the width of an edge that draws the eye
    int radius = (int)ceil(3 * sigma);
    kernel smooth = make_gaussian(radius, 1 / (2 * sigma * sigma), &sum);
    kernel derivative = make_derivative(radius, sigma, second);
    float *down = mem_alloc(count * sizeof *down);
    filter_rows_columns(p, &derivative, &smooth, plane, out);
    filter_rows_columns(p, &smooth, &derivative, plane, down);
    for (size_t i = 0; i < count; i++) out[i] = hypotf(out[i], down[i]);
    mem_free(down);
    mem_free(derivative.weights);
    mem_free(smooth.weights);
}

static void convert_brightness(void *user, size_t first, size_t end) {
    const conversion *v = user;
    for (size_t i = first; i < end; i++)
        v->planes[i] = (float)((ycxcz(v->rgb + i * 3).x + 16) / 116);
}

static float *make_brightness(const compare_picture *p) {
    size_t count = pixels_of(p);
    float *plane = mem_alloc(count * sizeof *plane);
    share_out(count, PIXELS_EACH, convert_brightness, &(conversion){p->rgb, plane, count});
    return plane;
}

// Returns the greater of both differences, 0 to 1, at each pixel.
static float *make_feature_errors(const compare_picture *a, const compare_picture *b, double ppd) {
    size_t count = pixels_of(a), size = count * sizeof(float);
    float *bright_a = make_brightness(a), *bright_b = make_brightness(b);
    float *found_a = mem_alloc(size), *found_b = mem_alloc(size), *errors = mem_alloc(size);
    for (int second = 0; second < 2; second++) {
        find_features(a, bright_a, ppd, second, found_a);
        find_features(b, bright_b, ppd, second, found_b);
        for (size_t i = 0; i < count; i++)
            errors[i] = fmaxf(errors[i], fabsf(found_a[i] - found_b[i]));
    }
    for (size_t i = 0; i < count; i++)
        errors[i] = sqrtf(clampf(errors[i] * (float)M_SQRT1_2, 0, 1));
    mem_free(found_b);
    mem_free(found_a);
    mem_free(bright_b);
    mem_free(bright_a);
    return errors;
}

double compare_flip(const compare_picture *a, const compare_picture *b, double pixels_per_degree,
                    float *map) {
    assert(a->width == b->width && a->height == b->height && pixels_per_degree > 0);
    size_t count = pixels_of(a);
    color_errors(a, b, pixels_per_degree, map);
    float *features = make_feature_errors(a, b, pixels_per_degree);
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        map[i] = clampf(powf(map[i], 1 - features[i]), 0, 1);
        sum += (double)map[i];
    }
    mem_free(features);
    return sum / (double)count;
}
