// Templates by hand: put into a flow one by one, and taken out of it as pictures.
#include "base/error.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/str.h"
#include "pass/slices/slices_templates_parts.h"
#include <math.h>
#include <string.h>

enum { VALUES = 3 }; // of a template in the shader's block: vectors of four

// ---- putting ----------------------------------------------------------------------------------

void slices_take_hand(pass *p) {
    slices_templates_make(slices_of(p))->hand.taken = true;
}

// Without a picture: upwards everywhere.
void slices_hand_tile(const void *templates, uint32_t slot, float *out) {
    const slices_templates *t = templates;
    static const float up[4] = {0, 1, 0, 1};
    const picture push = {1, 1, 0, up}, *image = t->hand.images[slot];
    template_tile(image ? image : &push, out);
}

static uint32_t find_slot(const template_hand *h) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < SLICES_HAND_MOST; i++)
        if (h->left[i] < h->left[found]) found = i;
    return found;
}

bool slices_put(pass *p, const slices_hand *hand) {
    slices_templates *t = slices_of(p)->templates;
    if (!t || !t->hand.taken || !t->set.tiles)
        return err_set("%s: it takes no templates by hand", p->label);
    template_hand *h = &t->hand;
    uint32_t slot = find_slot(h);
    if (h->images[slot] != hand->image) {
        h->images[slot] = hand->image;
        slices_hand_tile(t, slot,
                         t->set.tiles + (size_t)(t->set.group_count + slot) * TEMPLATE_TILE_VALUES);
        t->repainted = true;
    }
    h->at[slot] = *hand;
    // At the least the next step, whatever the lifetime.
    h->left[slot] = fmax(hand->lifetime, 0.5 * slices_of(p)->clock.step);
    return true;
}

static void fill_one(const slices_flow *f, const slices_hand *hand, uint32_t tile,
                     float out[4 * VALUES]) {
    const float cells = (float)f->desc.size[0], turn = glm_rad(hand->angle);
    const float values[4 * VALUES] = {
        hand->place[0] * cells,
        hand->place[1] * cells,
        fmaxf(0.5f * hand->size * cells, 1.5f),
        hand->strength,
        cosf(turn),
        sinf(turn),
        hand->pushes ? 1 : clampf(hand->blend, 0, 1),
        hand->pushes ? -1 - (float)tile : (float)tile,
        (float)hand->slice,
    };
    memcpy(out, values, sizeof values);
}

void slices_hand_set(slices_flow *f, kernel *k) {
    slices_templates *t = f->templates;
    float values[4 * VALUES * SLICES_HAND_MOST] = {0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < SLICES_HAND_MOST; i++) {
        if (t->hand.left[i] <= 0) continue;
        fill_one(f, &t->hand.at[i], t->set.group_count + i, values + 4 * VALUES * count++);
        t->hand.left[i] = fmax(t->hand.left[i] - f->clock.step, 0);
    }
    kernel_set(k, N_hand, values, sizeof values);
    kernel_set_int(k, N_hand_count, (int32_t)count);
}

void slices_hand_line(const slices_hand *hand, const char *variable, const char *file,
                      strbuf *out) {
    strbuf_add(out, "%s:templates { image \"%s\", kind = \"%s\", count = 1, ", variable, file,
               hand->pushes ? "velocity" : "pressure");
    strbuf_add(out, "region = disc { %.3g, %.3g, radius = 0.005 }, size = %.3g, ",
               (double)hand->place[0], (double)hand->place[1], (double)hand->size);
    strbuf_add(out, "align = \"fixed\", angle = %.3g, strength = %.3g", (double)hand->angle,
               (double)hand->strength);
    if (!hand->pushes) strbuf_add(out, ", blend = %.3g", (double)hand->blend);
    if (hand->lifetime > 0) strbuf_add(out, ", lifetime = %.3g", hand->lifetime);
    strbuf_add(out, " }\n");
}

// ---- capturing --------------------------------------------------------------------------------

typedef struct look { // at a slice
    uint32_t size[2];
    int channels;
    const uint16_t *halves;
} look;

static float sample(const look *l, float x, float y, int channel) { // in cells
    x = clampf(x - 0.5f, 0, (float)l->size[0] - 1);
    y = clampf(y - 0.5f, 0, (float)l->size[1] - 1);
    uint32_t i = (uint32_t)x, j = (uint32_t)y;
    uint32_t right = i + 1 < l->size[0] ? 1 : 0, above = j + 1 < l->size[1] ? 1 : 0;
    const uint16_t *at = l->halves + ((size_t)j * l->size[0] + i) * (size_t)l->channels + channel;
    size_t next = right * (size_t)l->channels,
           row = above * (size_t)l->size[0] * (size_t)l->channels;
    float low = mixf(half_to_float(at[0]), half_to_float(at[next]), x - (float)i);
    float high = mixf(half_to_float(at[row]), half_to_float(at[row + next]), x - (float)i);
    return mixf(low, high, y - (float)j);
}

// All slices of the last kept step; free with mem_free. NULL with a message.
static uint16_t *read_look(const slices_flow *f, flow_look which, int channels) {
    gpu_image *image = flow_image(f->solver, which, 0);
    if (!image) return ERR_NULL("%s: nothing has flowed yet", f->pass->label);
    size_t size = (size_t)f->desc.size[0] * f->desc.size[1] * f->desc.count * (size_t)channels * 2;
    uint16_t *halves = mem_alloc(size);
    if (gpu_image_read(f->pass->host->device, image, halves, size)) return halves;
    mem_free(halves);
    return NULL;
}

typedef struct square { // of a slice, in cells
    float low[2], side;
} square;

static void take(const look *velocity, const look *scalars, const square *s, float *rgba) {
    for (int y = 0; y < TEMPLATE_TILE; y++) // rows from the top
        for (int x = 0; x < TEMPLATE_TILE; x++) {
            float at[2] = {s->low[0] + s->side * ((float)x + 0.5f) / TEMPLATE_TILE,
                           s->low[1] + s->side * (1 - ((float)y + 0.5f) / TEMPLATE_TILE)};
            float *texel = rgba + 4 * (y * TEMPLATE_TILE + x);
            texel[0] = sample(velocity, at[0], at[1], 0);
            texel[1] = sample(velocity, at[0], at[1], 1);
            texel[2] = sample(scalars, at[0], at[1], 3);
            texel[3] = 1;
        }
}

// Pressure means something only by how it differs from that around.
static void level_pressure(float *rgba) {
    double sum = 0;
    int count = 0;
    for (int i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++) {
        int x = i % TEMPLATE_TILE, y = i / TEMPLATE_TILE;
        if (x > 0 && x < TEMPLATE_TILE - 1 && y > 0 && y < TEMPLATE_TILE - 1) continue;
        sum += (double)rgba[4 * i + 2];
        count++;
    }
    for (int i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++) rgba[4 * i + 2] -= (float)(sum / count);
}

static void normalize(float *rgba, float scale[2]) {
    scale[0] = scale[1] = 0;
    for (int i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++) {
        scale[0] = fmaxf(scale[0], hypotf(rgba[4 * i], rgba[4 * i + 1]));
        scale[1] = fmaxf(scale[1], fabsf(rgba[4 * i + 2]));
    }
    for (int i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++) {
        for (int c = 0; c < 2 && scale[0] > 0; c++) rgba[4 * i + c] /= scale[0];
        if (scale[1] > 0) rgba[4 * i + 2] /= scale[1];
    }
}

bool slices_capture(const pass *p, uint32_t slice, const float place[2], float size, arena *memory,
                    picture *out, float scale[2]) {
    const slices_flow *f = slices_of(p);
    const float cells = (float)f->desc.size[0];
    const size_t layer = (size_t)f->desc.size[0] * f->desc.size[1];
    if (slice >= f->desc.count) return err_set("%s: there is no slice %u", p->label, slice + 1);
    uint16_t *velocities = read_look(f, FLOW_VELOCITY, 2);
    uint16_t *others = velocities ? read_look(f, FLOW_SCALARS, 4) : NULL;
    if (others) {
        const look velocity = {
            {f->desc.size[0], f->desc.size[1]}, 2, velocities + 2 * layer * slice};
        const look scalars = {{f->desc.size[0], f->desc.size[1]}, 4, others + 4 * layer * slice};
        const square s = {{(place[0] - size / 2) * cells, (place[1] - size / 2) * cells},
                          size * cells};
        float *rgba = arena_alloc(memory, TEMPLATE_TILE_VALUES * sizeof *rgba);
        take(&velocity, &scalars, &s, rgba);
        level_pressure(rgba);
        normalize(rgba, scale);
        *out = (picture){TEMPLATE_TILE, TEMPLATE_TILE, 0, rgba};
        template_tile_fade(rgba);
    }
    mem_free(velocities);
    mem_free(others);
    return others != NULL;
}
