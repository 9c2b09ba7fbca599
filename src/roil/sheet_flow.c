// Motion where nothing says a velocity: from each cell to the next, and from it back to the one
// before, as optical flow. What is kept is the mean of both ways, which is how it moves there.
#include "base/memory.h"
#include "media/optical_flow.h"
#include "roil/sheet.h"
#include <math.h>

// As an eye sees it, before grey: then both smoke and fire stand out.
void sheet_picture(const sheet *s, uint32_t cell, uint8_t *out) {
    static const float behind = 0.2f;
    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            const float *p = sheet_pixel(s, cell, x, y);
            float light = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] + behind * (1 - p[3]);
            *out++ = (uint8_t)lrintf(255 * roil_srgb(light));
        }
}

typedef struct pair {
    uint8_t *from, *to;
    float *flow;
} pair;

// Adds the way to another cell, `sign` times, in heights of the cell a second.
static bool add_way(roil_sheet *s, const sheet *colors, uint32_t cell, uint32_t other, float scale,
                    const pair *p) {
    const sheet *motion = &s->maps[SHEET_MOTION];
    sheet_picture(colors, cell, p->from);
    sheet_picture(colors, other, p->to);
    if (!optical_flow_find(p->from, p->to, s->cell, s->cell, p->flow)) return false;
    const float *way = p->flow;
    for (uint32_t y = 0; y < s->cell; y++)
        for (uint32_t x = 0; x < s->cell; x++, way += 2) {
            const float *c = sheet_pixel(colors, cell, x, y);
            const float weight = c[3] + (c[0] + c[1] + c[2]) / 3;
            float *to = sheet_pixel(motion, cell, x, y);
            to[0] += weight * scale * way[0];
            to[1] -= weight * scale * way[1];
            to[3] += weight;
        }
    return true;
}

bool sheet_find_flow(roil_sheet *s, uint32_t count, bool loops, double fps) {
    const sheet *colors = &s->maps[s->maps[SHEET_SHOWN].pixels ? SHEET_SHOWN : SHEET_SCENE];
    const size_t pixels = (size_t)s->cell * s->cell;
    const float scale = (float)fps / (float)s->cell;
    pair p = {mem_alloc(pixels), mem_alloc(pixels), mem_alloc(2 * pixels * sizeof(float))};
    bool done = true;
    for (uint32_t i = 0; done && i < count && count > 1; i++) {
        const uint32_t next = (i + 1) % count, before = (i + count - 1) % count;
        if (i + 1 < count || loops) done = add_way(s, colors, i, next, scale, &p);
        if (done && (i > 0 || loops)) done = add_way(s, colors, i, before, -scale, &p);
    }
    mem_free(p.from);
    mem_free(p.to);
    mem_free(p.flow);
    return done;
}
