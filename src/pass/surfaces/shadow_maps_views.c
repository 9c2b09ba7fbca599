// Views of sun and spots, and squares in the atlas: numbers alone.
#include "base/maths.h"
#include "pass/surfaces/shadow_maps_parts.h"
#include <math.h>
#include <string.h>

void shadow_maps_split(float near, float far, float mix, uint32_t count, float *ends) {
    for (uint32_t i = 0; i < count; i++) {
        float part = (float)(i + 1) / (float)count;
        ends[i] = mixf(near + (far - near) * part, near * powf(far / near, part), mix);
    }
}

// As `across` of lib/across.glsl.
static void make_across(const vec3 n, vec3 right, vec3 up) {
    float side = n[2] >= 0 ? 1.0f : -1.0f, a = -1 / (side + n[2]), b = n[0] * n[1] * a;
    glm_vec3_copy((vec3){1 + side * n[0] * n[0] * a, side * b, -side * n[0]}, right);
    glm_vec3_copy((vec3){b, side + n[1] * n[1] * a, -n[1]}, up);
}

// Row `row` of the matrix: a number for each part of a place.
static void set_row(struct shadow_view *v, int row, const vec3 way, float scale, float offset) {
    for (int i = 0; i < 3; i++) v->clip.m[4 * i + row] = way[i] * scale;
    v->clip.m[12 + row] = offset;
}

static void set_axes(struct shadow_view *v, const vec3 right, const vec3 up, float texel,
                     float parallel) {
    memcpy(v->right.v, right, sizeof(vec3));
    memcpy(v->up.v, up, sizeof(vec3));
    v->right.v[3] = texel;
    v->up.v[3] = parallel;
}

// The least sphere about the corners of that part of the camera's pyramid.
static float bound(const struct frame_block *frame, float near, float far, vec3 centre) {
    const float *m = frame->view_inverse.m;
    const float across[2] = {frame->lens.v[0] * (1 + fabsf(frame->shift.v[0])),
                             frame->lens.v[1] * (1 + fabsf(frame->shift.v[1]))};
    float k = across[0] * across[0] + across[1] * across[1];
    float deep = fminf(0.5f * (near + far) * (1 + k), far);
    for (int i = 0; i < 3; i++) centre[i] = frame->eye.v[i] - m[8 + i] * deep;
    return sqrtf((far - deep) * (far - deep) + k * far * far);
}

void shadow_maps_cascade(const struct frame_block *frame, const float sun[3], float near, float far,
                         float reach, uint32_t size, float margin, struct shadow_view *out) {
    vec3 right, up, along, centre;
    float radius = bound(frame, near, far, centre);
    // Half a texel on either side is what moving by whole texels takes.
    float texel = 2 * radius / ((float)size - 2 * margin - 1), half = 0.5f * texel * (float)size;
    glm_vec3_negate_to((float *)sun, along);
    make_across(along, right, up);
    float x = texel * roundf(glm_vec3_dot(right, centre) / texel);
    float y = texel * roundf(glm_vec3_dot(up, centre) / texel);
    float low = glm_vec3_dot(along, centre) - radius - reach;
    float deep = 2 * radius + reach;
    *out = (struct shadow_view){0};
    set_row(out, 0, right, 1 / half, -x / half);
    set_row(out, 1, up, 1 / half, -y / half);
    set_row(out, 2, along, 1 / deep, -low / deep);
    out->clip.m[15] = 1;
    set_axes(out, right, up, texel, 1);
}

bool shadow_maps_spot(const struct light_entry *light, float far, uint32_t size, float margin,
                      struct shadow_view *out) {
    vec3 right, up, along, place;
    float cosine = light->axis.v[3];
    if (cosine < cosf(glm_rad(SHADOW_WIDEST_SPOT) / 2)) return false;
    memcpy(along, light->axis.v, sizeof along);
    memcpy(place, light->position.v, sizeof place);
    make_across(along, right, up);
    float half = sqrtf(fmaxf(1 - cosine * cosine, 1e-6f)) / cosine;
    half *= (float)size / ((float)size - 2 * margin);
    // As near as a float's digits allow, which are spread as one over the depth.
    float near = fmaxf(light->position.v[3], fmaxf(far * 5e-4f, 0.01f));
    float slope = far / (far - near);
    float deep = glm_vec3_dot(along, place);
    *out = (struct shadow_view){0};
    set_row(out, 0, right, 1 / half, -glm_vec3_dot(right, place) / half);
    set_row(out, 1, up, 1 / half, -glm_vec3_dot(up, place) / half);
    set_row(out, 2, along, slope, -slope * (deep + near));
    set_row(out, 3, along, 1, -deep);
    set_axes(out, right, up, 2 * half / (float)size, 0);
    return true;
}

// ---- the atlas --------------------------------------------------------------------------------

// Every second bit.
static uint32_t compact(uint64_t v) {
    uint32_t out = 0;
    for (int i = 0; i < 32; i++) out |= (uint32_t)(v >> (2 * i) & 1) << i;
    return out;
}

// Along a curve that fills a square quarter by quarter (Morton, 1966), square below square.
static uint32_t pack(const uint32_t *sizes, uint32_t count, uint32_t width, uint32_t (*places)[4]) {
    uint64_t used = 0, whole = (uint64_t)width * width;
    uint32_t height = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = compact(used % whole), y = compact((used % whole) >> 1);
        y += (uint32_t)(used / whole) * width;
        memcpy(places[i], (uint32_t[4]){x, y, sizes[i], sizes[i]}, sizeof places[i]);
        used += (uint64_t)sizes[i] * sizes[i];
        if (height < y + sizes[i]) height = y + sizes[i];
    }
    return height;
}

bool shadow_maps_pack(const uint32_t *sizes, uint32_t count, uint32_t most, uint32_t (*places)[4],
                      uint32_t atlas[2]) {
    uint32_t width = count ? sizes[0] : 1, height = pack(sizes, count, width, places);
    for (; height > 2 * width && width <= most; height = pack(sizes, count, width, places))
        width *= 2;
    atlas[0] = width;
    atlas[1] = height ? height : 1;
    return width <= most && height <= most;
}
