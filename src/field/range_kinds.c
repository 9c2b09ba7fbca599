// Ranges of kinds: those of shaders/lib/range_*.glsl, by the same functions of single numbers.
#include "field/kinds.h"
#include <math.h>

// ---- operators --------------------------------------------------------------------------------

#define EACH(NAME, EXPRESSION)                                                                     \
    intervals ranges_##NAME(const field_box *in, const intervals *args) {                          \
        (void)in;                                                                                  \
        intervals out;                                                                             \
        for (int i = 0; i < 4; i++) out.c[i] = EXPRESSION;                                         \
        return out;                                                                                \
    }
#define EACH_1(NAME) EACH(NAME, range_##NAME(args[0].c[i]))
#define EACH_2(NAME) EACH(NAME, range_##NAME(args[0].c[i], args[1].c[i]))
#define EACH_3(NAME) EACH(NAME, range_##NAME(args[0].c[i], args[1].c[i], args[2].c[i]))

EACH_2(add)
EACH_2(sub)
EACH_2(mul)
EACH_1(negate)
EACH_2(div)
EACH_2(min)
EACH_2(max)
EACH_3(mix)
EACH_3(clamp)
EACH_3(smoothstep)
EACH_2(step)
EACH_2(pow)
EACH_1(abs)
EACH_1(sqrt)
EACH_1(exp)
EACH_1(sin)
EACH_1(floor)
EACH_1(fract)
EACH(remap, range_remap(args[0].c[i], args[1].c[i], args[2].c[i], args[3].c[i], args[4].c[i]))

static intervals alone(range1 a) {
    return (intervals){{a}};
}

static range1 dot(const intervals *a, const intervals *b, int width) {
    range1 sum = range_mul(a->c[0], b->c[0]);
    for (int i = 1; i < width; i++) sum = range_add(sum, range_mul(a->c[i], b->c[i]));
    return sum;
}

static range1 length(const intervals *a, int width) {
    intervals b = {0};
    for (int i = 0; i < width; i++) b.c[i] = range_abs(a->c[i]);
    return width == 1 ? b.c[0] : range_sqrt(dot(&b, &b, width));
}

intervals ranges_dot(const field_box *in, const intervals *args) {
    return alone(dot(&args[0], &args[1], kind_arg_width(in->node, 0)));
}

intervals ranges_length(const field_box *in, const intervals *args) {
    return alone(length(&args[0], kind_arg_width(in->node, 0)));
}

static intervals all_in(float low, float high) {
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = range1(low, high);
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
    range1 values = size > 0 ? range1(-size, size) : range_unknown1();
    for (int i = 0; inside && i < 4; i++) out.c[i] = values;
    return out;
}

intervals ranges_palette(const field_box *in, const intervals *args) {
    float low, high;
    palette_range(in->node->object, &low, &high);
    float from = clampf((args[0].c[0].low - low) / (high - low), 0, 1) * PALETTE_SIZE - 0.51f;
    float to = clampf((args[0].c[0].high - low) / (high - low), 0, 1) * PALETTE_SIZE + 0.51f;
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = range1(RANGE_END, -RANGE_END);
    for (float i = floorf(from); i <= floorf(to); i++) {
        float at_texel = low + (i + 0.5f) / PALETTE_SIZE * (high - low), texel[4];
        palette_eval(in->node->object, in->context->time, at_texel, texel);
        for (int c = 0; c < 4; c++)
            out.c[c] =
                range_union(out.c[c], range1(texel[c] * (1 - 1e-3f), texel[c] * (1 + 1e-3f)));
    }
    return out;
}

intervals ranges_unknown(const field_box *in, const intervals *args) {
    (void)in, (void)args;
    intervals out;
    for (int i = 0; i < 4; i++) out.c[i] = range_unknown1();
    return out;
}

// ---- shapes -----------------------------------------------------------------------------------

static intervals solid(range1 distance, range1 falloff) {
    return alone(range_density(distance, falloff));
}

static intervals difference(const intervals *a, const intervals *b) {
    intervals out = {0};
    for (int i = 0; i < 3; i++) out.c[i] = range_sub(a->c[i], b->c[i]);
    return out;
}

intervals ranges_sphere(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]);
    return solid(range_sub(length(&q, 3), args[1].c[0]), args[2].c[0]);
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
        range1 side = range_sub(range_abs(q.c[i]), range_mul(args[1].c[i], range1(0.5f, 0.5f)));
        low[i] = clampf(side.low, -RANGE_MOST, RANGE_MOST);
        high[i] = fminf(side.high, RANGE_MOST);
    }
    return solid(range_wide(box_distance(low), box_distance(high)), args[2].c[0]);
}

static float middle(range1 a) {
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
    if (!(reach < 1e6f)) return alone(range1(0, 1));
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
    return solid(range_sub(range_wide(fmaxf(d - reach, 0), d + reach), args[2].c[0]), args[3].c[0]);
}

intervals ranges_torus(const field_box *in, const intervals *args) {
    intervals q = difference(in->at, &args[0]), flat = {{q.c[0], q.c[1]}};
    intervals tube = {{range_sub(length(&flat, 3), args[1].c[0]), q.c[2]}};
    return solid(range_sub(length(&tube, 3), args[2].c[0]), args[3].c[0]);
}

intervals ranges_disc(const field_box *in, const intervals *args) {
    intervals q = {{range_sub(in->at->c[0], args[0].c[0]), range_sub(in->at->c[1], args[1].c[0])}};
    return solid(range_sub(length(&q, 3), args[2].c[0]), args[3].c[0]);
}

// ---- bursts -----------------------------------------------------------------------------------

static range1 away(const intervals *at, const intervals *position) {
    intervals q = difference(at, position);
    return length(&q, 3);
}

intervals ranges_blast_pressure(const field_box *in, const intervals *args) {
    return alone(range_blast_pressure(away(in->at, &args[0]), args[1].c[0], args[2].c[0]));
}

intervals ranges_blast_velocity(const field_box *in, const intervals *args) {
    range1 each = range_blast_velocity(away(in->at, &args[0]), args[1].c[0], args[2].c[0]);
    return (intervals){{each, each, each}};
}

intervals ranges_blast_impulse(const field_box *in, const intervals *args) {
    return alone(range_blast_impulse(away(in->at, &args[0]), args[1].c[0]));
}

intervals ranges_blast_arrival(const field_box *in, const intervals *args) {
    return alone(range_blast_arrival(away(in->at, &args[0]), args[1].c[0]));
}
