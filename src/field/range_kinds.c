// Ranges of kinds: the twin of shaders/lib/range_operator.glsl, range_shape.glsl,
// range_blast.glsl and, by noise_range.c, of range_noise.glsl. The reasons are given there.
#include "field/kinds.h"
#include <math.h>

static const float most = 1e15f, end = 1e30f, rounding = 1e-6f;

static bool is_zero(interval a) {
    return a.low == 0 && a.high == 0;
}

// ---- operators --------------------------------------------------------------------------------

#define EACH(NAME, EXPRESSION)                                                                     \
    intervals ranges_##NAME(const field_box *in, const intervals *args) {                          \
        (void)in;                                                                                  \
        intervals out;                                                                             \
        for (int i = 0; i < 4; i++) out.c[i] = EXPRESSION;                                         \
        return out;                                                                                \
    }
#define A args[0].c[i]
#define B args[1].c[i]
#define C args[2].c[i]

static interval negate(interval a) {
    return (interval){-a.high, -a.low};
}

static interval smaller(interval a, interval b) {
    return (interval){fminf(a.low, b.low), fminf(a.high, b.high)};
}

static interval greater(interval a, interval b) {
    return (interval){fmaxf(a.low, b.low), fmaxf(a.high, b.high)};
}

static interval absolute(interval a) {
    return (interval){fmaxf(fmaxf(a.low, -a.high), 0), fmaxf(a.high, -a.low)};
}

static interval divide(interval a, interval b) {
    if (is_zero(a) || is_zero(b)) return (interval){0, 0};
    if (b.low > 0 || b.high < 0)
        return range_mul(a,
                         range_wide(b.high > most ? 0 : 1 / b.high, b.low < -most ? 0 : 1 / b.low));
    if (a.low >= 0 && b.low == 0) return (interval){0, end};
    return range_unknown();
}

static interval step(interval v, interval edge) {
    float low = rounding * (fabsf(v.low) + fabsf(edge.high));
    float high = rounding * (fabsf(v.high) + fabsf(edge.low));
    return (interval){v.low - low >= edge.high ? 1 : 0, v.high + high >= edge.low ? 1 : 0};
}

static float smooth(float v, float low, float high) {
    float t = clampf((v - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

static interval smooth_range(interval v, interval low, interval high) {
    const float rest = 1 - 2 * rounding;
    float least = 0, greatest = 1;
    if (low.low == low.high && high.low == high.high && low.low == high.low) return step(v, low);
    if (low.high < high.low) {
        least = smooth(v.low, low.high, high.high);
        greatest = smooth(v.high, low.low, high.low);
    } else if (low.low > high.high) {
        least = smooth(v.high, low.low, high.low);
        greatest = smooth(v.low, low.high, high.high);
    }
    return (interval){least < 1 ? least * rest : 1, greatest > 0 ? fminf(greatest / rest, 1) : 0};
}

static float power(float a, float b) {
    return a <= 0 ? (b == 0 ? 1.0f : 0.0f) : powf(a, b);
}

static interval power_range(interval a, interval b) {
    const float inexact = 1e-5f;
    bool may_be_1 = b.low <= 0 && b.high >= 0, is_1 = b.low == 0 && b.high == 0;
    if (a.high <= 0 || is_1) return (interval){is_1 ? 1 : 0, may_be_1 ? 1 : 0};
    float from = fmaxf(a.low, 0), ll = power(from, b.low), lh = power(from, b.high);
    float hl = power(a.high, b.low), hh = power(a.high, b.high);
    float low = fminf(fminf(ll, lh), fminf(hl, hh)) * (1 - inexact);
    float high = fmaxf(fmaxf(ll, lh), fmaxf(hl, hh)) * (1 + inexact);
    bool endless = (a.high > most && b.high > 0) || (a.low <= 0 && b.low < 0);
    if (a.low <= 0 || (a.high > most && b.low < 0)) low = 0;
    if (may_be_1) high = fmaxf(high, 1);
    return range_make(low, endless ? end : high);
}

static interval root(interval a) {
    return range_wide(sqrtf(fmaxf(a.low, 0)), a.high > most ? end : sqrtf(fmaxf(a.high, 0)));
}

static interval exponential(interval a) {
    const float inexact = 1e-4f;
    return range_make(expf(fminf(a.low, 80)) * (1 - inexact),
                      expf(fminf(a.high, 80)) * (1 + inexact));
}

static interval sine(interval a) {
    float middle = 0.5f * (a.low + a.high), reach = 0.5f * (a.high - a.low) + 1e-3f;
    if (!(reach < 3) || fabsf(middle) > 1e3f) return (interval){-1, 1};
    return (interval){fmaxf(sinf(middle) - reach, -1), fminf(sinf(middle) + reach, 1)};
}

static interval fraction(interval a) {
    float whole = floorf(a.low);
    if (whole != floorf(a.high) || fabsf(a.high) > 1e6f) return (interval){0, 1};
    return (interval){a.low - whole, a.high - whole};
}

static interval remap(interval v, interval in_min, interval in_max, interval out_min,
                      interval out_max) {
    interval t = divide(range_sub(v, in_min), range_sub(in_max, in_min));
    return range_add(out_min, range_mul(t, range_sub(out_max, out_min)));
}

EACH(add, range_add(A, B))
EACH(sub, range_sub(A, B))
EACH(mul, range_mul(A, B))
EACH(negate, negate(A))
EACH(div, divide(A, B))
EACH(min, smaller(A, B))
EACH(max, greater(A, B))
EACH(mix, range_mix(A, B, C))
EACH(clamp, smaller(greater(A, B), C))
EACH(smoothstep, smooth_range(A, B, C))
EACH(step, step(A, B))
EACH(pow, power_range(A, B))
EACH(abs, absolute(A))
EACH(sqrt, root(A))
EACH(exp, exponential(A))
EACH(sin, sine(A))
EACH(floor, range_make(floorf(A.low), floorf(A.high)))
EACH(fract, fraction(A))
EACH(remap, remap(A, B, C, args[3].c[i], args[4].c[i]))

static intervals alone(interval a) {
    return (intervals){{a}};
}

static interval dot(const intervals *a, const intervals *b, int width) {
    interval sum = range_mul(a->c[0], b->c[0]);
    for (int i = 1; i < width; i++) sum = range_add(sum, range_mul(a->c[i], b->c[i]));
    return sum;
}

static interval length(const intervals *a, int width) {
    intervals b = {0};
    for (int i = 0; i < width; i++) b.c[i] = absolute(a->c[i]);
    return width == 1 ? b.c[0] : root(dot(&b, &b, width));
}

intervals ranges_dot(const field_box *in, const intervals *args) {
    return alone(dot(&args[0], &args[1], kind_arg_width(in->node, 0)));
}

intervals ranges_length(const field_box *in, const intervals *args) {
    return alone(length(&args[0], kind_arg_width(in->node, 0)));
}

static intervals all_in(float low, float high) {
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = (interval){low, high};
    return out;
}

intervals ranges_atan(const field_box *in, const intervals *args) {
    (void)in, (void)args;
    return all_in(-3.1416f, 3.1416f);
}

intervals ranges_share(const field_box *in, const intervals *args) {
    (void)in, (void)args;
    return all_in(0, 1);
}

intervals ranges_way(const field_box *in, const intervals *args) {
    (void)in, (void)args;
    return all_in(-1, 1);
}

intervals ranges_vec(const field_box *in, const intervals *args) {
    (void)in;
    return (intervals){{args[0].c[0], args[1].c[0], args[2].c[0]}};
}

intervals ranges_swizzle(const field_box *in, const intervals *args) {
    intervals out = {0};
    for (int i = 0; i < in->node->components; i++)
        out.c[i] = args[0].c[in->node->index >> 2 * i & 3];
    return out;
}

intervals ranges_position(const field_box *in, const intervals *args) {
    (void)args;
    return *in->at;
}

// ---- sources ----------------------------------------------------------------------------------

// Nothing outside of the grid's box; within, its values are on the device.
intervals ranges_grid(const field_box *in, const intervals *args) {
    (void)args;
    const field_grid *grid = in->node->object;
    box3 box = {{in->at->c[0].low, in->at->c[1].low, in->at->c[2].low},
                {in->at->c[0].high, in->at->c[1].high, in->at->c[2].high}};
    bool unread = in->context->unread > 0;
    box3 active = unread ? grid->box : box3_intersect(grid->box, grid->state.active);
    bool inside = grid->repeats || !(box.min.x > active.max.x || box.max.x < active.min.x ||
                                     box.min.y > active.max.y || box.max.y < active.min.y ||
                                     box.min.z > active.max.z || box.max.z < active.min.z);
    intervals out = {0};
    float size = grid->longest > 0 ? grid->longest : in->context->unread;
    interval values = size > 0 ? (interval){-size, size} : range_unknown();
    for (int i = 0; inside && i < 4; i++) out.c[i] = values;
    return out;
}

intervals ranges_palette(const field_box *in, const intervals *args) {
    float low, high;
    palette_range(in->node->object, &low, &high);
    float from = clampf((args[0].c[0].low - low) / (high - low), 0, 1) * PALETTE_SIZE - 0.51f;
    float to = clampf((args[0].c[0].high - low) / (high - low), 0, 1) * PALETTE_SIZE + 0.51f;
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = (interval){end, -end};
    for (float i = floorf(from); i <= floorf(to); i++) {
        float at_texel = low + (i + 0.5f) / PALETTE_SIZE * (high - low), texel[4];
        palette_eval(in->node->object, in->context->time, at_texel, texel);
        for (int c = 0; c < 4; c++)
            out.c[c] =
                range_union(out.c[c], (interval){texel[c] * (1 - 1e-3f), texel[c] * (1 + 1e-3f)});
    }
    return out;
}

intervals ranges_unknown(const field_box *in, const intervals *args) {
    (void)in, (void)args;
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = range_unknown();
    return out;
}

// ---- shapes -----------------------------------------------------------------------------------

static float density(float distance, float falloff) {
    return falloff > 0 ? clampf(-distance / falloff, 0, 1) : distance <= 0 ? 1 : 0;
}

static intervals densities(interval distance, interval falloff) {
    return alone((interval){density(distance.high, falloff.high) * (1 - rounding),
                            fminf(density(distance.low, falloff.low) * (1 + rounding), 1)});
}

static intervals difference(const intervals *a, const intervals *b) {
    intervals out = {0};
    for (int i = 0; i < 3; i++) out.c[i] = range_sub(a->c[i], b->c[i]);
    return out;
}

intervals ranges_sphere(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]);
    return densities(range_sub(length(&q, 3), args[1].c[0]), args[2].c[0]);
}

static float box_distance(const float q[3]) {
    float square = 0;
    for (int i = 0; i < 3; i++) square += fmaxf(q[i], 0) * fmaxf(q[i], 0);
    return sqrtf(square) + fminf(fmaxf(q[0], fmaxf(q[1], q[2])), 0);
}

intervals ranges_box(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]);
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        interval side =
            range_sub(absolute(q.c[i]), range_mul(args[1].c[i], (interval){0.5f, 0.5f}));
        low[i] = clampf(side.low, -most, most);
        high[i] = fminf(side.high, most);
    }
    return densities(range_wide(box_distance(low), box_distance(high)), args[2].c[0]);
}

static float middle(interval a) {
    return 0.5f * (a.low + a.high);
}

static float half_diagonal(const intervals *a) {
    float square = 0;
    for (int i = 0; i < 3; i++) {
        float half = 0.5f * (a->c[i].high - a->c[i].low);
        square += half * half;
    }
    return sqrtf(square);
}

static float length3(const float v[3]) {
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

intervals ranges_capsule(const field_box *in, const intervals *args) {
    float reach = half_diagonal(in->at) + fmaxf(half_diagonal(&args[0]), half_diagonal(&args[1]));
    float p[3], a[3], b[3], line[3], along = 0, square = 0;
    if (!(reach < 1e6f)) return alone((interval){0, 1});
    for (int i = 0; i < 3; i++) {
        p[i] = middle(in->at->c[i]);
        a[i] = middle(args[0].c[i]);
        b[i] = middle(args[1].c[i]);
        line[i] = b[i] - a[i];
        along += (p[i] - a[i]) * line[i];
        square += line[i] * line[i];
    }
    reach += 1e-6f * (length3(p) + length3(a) + length3(b));
    float t = clampf(along / fmaxf(square, 1e-12f), 0, 1), r[3];
    for (int i = 0; i < 3; i++) r[i] = p[i] - a[i] - line[i] * t;
    float d = length3(r);
    return densities(range_sub(range_wide(fmaxf(d - reach, 0), d + reach), args[2].c[0]),
                     args[3].c[0]);
}

intervals ranges_torus(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]), flat = {{q.c[0], q.c[1]}};
    intervals tube = {{range_sub(length(&flat, 3), args[1].c[0]), q.c[2]}};
    return densities(range_sub(length(&tube, 3), args[2].c[0]), args[3].c[0]);
}

intervals ranges_disc(const field_box *in, const intervals *args) {
    intervals q = {{range_sub(in->at->c[0], args[0].c[0]), range_sub(in->at->c[1], args[1].c[0])}};
    return densities(range_sub(length(&q, 3), args[2].c[0]), args[3].c[0]);
}

// ---- bursts -----------------------------------------------------------------------------------

static const float inexact = 1e-4f;

static float greatest_peak(const intervals *at, const intervals *args) {
    intervals q = difference(at, &args[0]);
    const float scale = blast_scale(fminf(args[2].c[0].high, most));
    const float near = length(&q, 3).low / scale;
    if (args[1].c[0].high < scale * blast_front(near) * (1 - inexact)) return -1;
    return blast_excess(near) * (1 + inexact);
}

intervals ranges_blast_pressure(const field_box *in, const intervals *args) {
    const float ambient = 101325, suction = 0.1353353f,
                peak = ambient * greatest_peak(in->at, args);
    return alone(peak < 0 ? (interval){0, 0} : range_make(-suction * peak, peak));
}

intervals ranges_blast_velocity(const field_box *in, const intervals *args) {
    const float peak = greatest_peak(in->at, args), fast = peak < 0 ? 0 : blast_speed(peak);
    return all_in(-fast, fast);
}

intervals ranges_blast_impulse(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]);
    const interval away = length(&q, 3), charge = args[1].c[0];
    const float large = blast_scale(fminf(charge.high, most)), small = blast_scale(charge.low);
    return alone(range_make(small * blast_impulse(away.high / small) * (1 - inexact),
                            large * blast_impulse(away.low / large) * (1 + inexact)));
}

intervals ranges_blast_arrival(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]);
    const interval away = length(&q, 3), charge = args[1].c[0];
    const float large = blast_scale(fminf(charge.high, most)), small = blast_scale(charge.low);
    return alone(range_make(
        large * blast_front(away.low / large) * (1 - inexact),
        away.high > most ? end : small * blast_front(away.high / small) * (1 + inexact)));
}
