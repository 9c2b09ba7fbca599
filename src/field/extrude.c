#include "field/extrude.h"
#include <math.h>
#include <string.h>

static const float pi = 3.14159265358979323846f;

static float dot(float3 a, float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static float3 cross(float3 a, float3 b) {
    return (float3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static float3 scaled(float3 a, float s) {
    return (float3){a.x * s, a.y * s, a.z * s};
}

static float3 unit(float3 a, float3 otherwise) {
    float length = sqrtf(dot(a, a));
    return length > 1e-12f ? scaled(a, 1 / length) : otherwise;
}

// The first slice of an upright axis shows x to the right; of any other, what is left of that.
static float3 side_of(float3 along) {
    float3 x = {1, 0, 0}, y = {0, 1, 0};
    float3 from = fabsf(along.x) < 0.9f ? x : y;
    float3 part = scaled(along, dot(from, along));
    return unit((float3){from.x - part.x, from.y - part.y, from.z - part.z}, x);
}

field_extrusion field_extrusion_make(float3 position, float3 axis, float width, float height,
                                     uint32_t count) {
    float3 along = unit(axis, (float3){0, 0, 1});
    return (field_extrusion){
        .position = position,
        .along = along,
        .across = side_of(along),
        .width = width,
        .height = height,
        .count = count,
        .only = -1,
    };
}

box3 field_extrusion_box(const field_extrusion *e) {
    const float *low = &e->position.x, *along = &e->along.x;
    box3 box;
    float *min = &box.min.x, *max = &box.max.x;
    for (int i = 0; i < 3; i++) {
        float wide = 0.5f * e->width * sqrtf(fmaxf(1 - along[i] * along[i], 0));
        float high = e->height * along[i];
        min[i] = low[i] + fminf(high, 0) - wide;
        max[i] = low[i] + fmaxf(high, 0) + wide;
    }
    return box;
}

void field_extrusion_numbers(const field_extrusion *e, float out[EXTRUSION_NUMBERS]) {
    const float3 rows[3] = {scaled(e->across, 1 / e->width),
                            scaled(cross(e->along, e->across), 1 / e->width),
                            scaled(e->along, 1 / e->height)};
    for (int i = 0; i < 3; i++) {
        memcpy(out + 4 * i, &rows[i], sizeof rows[i]);
        out[4 * i + 3] = -dot(rows[i], e->position);
    }
    out[12] = e->width;
    out[13] = e->height;
    out[14] = (float)e->only;
    out[15] = (float)e->count;
}

field_extruded field_extrude(const field_extrusion *e, float3 p) {
    float3 q = {p.x - e->position.x, p.y - e->position.y, p.z - e->position.z};
    float3 aside = cross(e->along, e->across);
    float x = dot(q, e->across) / e->width, y = dot(q, aside) / e->width;
    float n = (float)e->count, radius = sqrtf(x * x + y * y), side = 1, layer;
    float c = radius > 0 ? x / radius : 1, s = radius > 0 ? y / radius : 0;
    if (e->only >= 0) {
        layer = (float)e->only;
        c = cosf(layer / n * pi);
        s = sinf(layer / n * pi);
        radius = x * c + y * s;
    } else {
        layer = atan2f(y, x) * (n / pi);
        if (layer < 0) {
            side = -1;
            layer += n;
        }
    }
    field_extruded out = {
        .at = {0.5f + side * radius, dot(q, e->along) / e->height, (layer + 0.5f) / (n + 1)}};
    out.inside = fabsf(out.at[0] - 0.5f) <= 0.5f && fabsf(out.at[1] - 0.5f) <= 0.5f;
    out.outward =
        (float3){side * (c * e->across.x + s * aside.x), side * (c * e->across.y + s * aside.y),
                 side * (c * e->across.z + s * aside.z)};
    return out;
}
