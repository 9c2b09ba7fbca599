// The end of a loop, where each cell becomes what came before the first one: two pictures that
// differ are moved onto each other along the optical flow between them while one fades into the
// other, so that edges stay single. They fade in place where there is no such flow, or where it
// does not bring them together: then it would only blur what it moves.
#include "base/error.h"
#include "base/memory.h"
#include "media/optical_flow.h"
#include "roil/sheet.h"
#include <math.h>
#include <string.h>

enum { REACH = 6 }; // a pixel moves a cell's side divided by this at most
// Share of the squared difference that may be left when both are moved: it is 0.04 to 0.07 of a
// puff that rises, and 0.29 to 0.57 of noise that drifts (scripts/bench/README.md).
static const float left_at_most = 0.15f;

static const float *known(const sheet *s, uint32_t cell, int x, int y) {
    static const float nothing[4];
    bool inside = x >= 0 && y >= 0 && x < (int)s->width && y < (int)s->height;
    return inside ? sheet_pixel(s, cell, (uint32_t)x, (uint32_t)y) : nothing;
}

// Adds what is between four pixels, times a weight.
static void add_sample(const sheet *s, uint32_t cell, float x, float y, float weight,
                       float out[4]) {
    const float left = floorf(x), top = floorf(y), u = x - left, v = y - top;
    const float parts[] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    for (int i = 0; i < 4; i++) {
        const float *p = known(s, cell, (int)left + (i & 1), (int)top + (i >> 1));
        for (int c = 0; c < 4; c++) out[c] += weight * parts[i] * p[c];
    }
}

static sheet_map colors_of(const roil_sheet *s) {
    return s->maps[SHEET_SHOWN].pixels ? SHEET_SHOWN : SHEET_SCENE;
}

// The way from one picture to the other at each place, the mean of both directions; all 0: unknown.
static bool find_way(const roil_sheet *s, uint32_t cell, uint32_t slot, float *way) {
    const sheet_map seen = colors_of(s);
    const size_t pixels = (size_t)s->cell * s->cell;
    uint8_t *from = mem_alloc(pixels), *to = mem_alloc(pixels);
    float *back = mem_alloc(2 * pixels * sizeof *back);
    sheet_picture(&s->maps[seen], cell, from);
    sheet_picture(&s->before[seen], slot, to);
    bool done = optical_flow_find(from, to, s->cell, s->cell, way) &&
                optical_flow_find(to, from, s->cell, s->cell, back);
    const float most = (float)s->cell / REACH;
    for (size_t i = 0; done && i < 2 * pixels; i++) {
        const float mean = (way[i] - back[i]) / 2;
        way[i] = isfinite(mean) ? clampf(mean, -most, most) : 0;
    }
    mem_free(from);
    mem_free(to);
    mem_free(back);
    return done;
}

// Sets whether both pictures look alike once each is moved by half of the way.
static bool find_whether_alike(const roil_sheet *s, uint32_t cell, uint32_t slot, float *way,
                               bool *alike) {
    const sheet *own = &s->maps[colors_of(s)], *before = &s->before[colors_of(s)];
    float still = 0, moved = 0;
    if (!find_way(s, cell, slot, way)) return false;
    for (uint32_t y = 0; y < s->cell; y++)
        for (uint32_t x = 0; x < s->cell; x++, way += 2) {
            const float at[] = {(float)x, (float)y}, half[] = {way[0] / 2, way[1] / 2};
            float here[4] = {0}, there[4] = {0};
            add_sample(own, cell, at[0], at[1], 1, here);
            add_sample(before, slot, at[0], at[1], -1, here);
            add_sample(own, cell, at[0] - half[0], at[1] - half[1], 1, there);
            add_sample(before, slot, at[0] + half[0], at[1] + half[1], -1, there);
            for (int c = 0; c < 4; c++) {
                still += fminf(here[c] * here[c], 1);
                moved += fminf(there[c] * there[c], 1);
            }
        }
    *alike = moved < left_at_most * still;
    return true;
}

// `rate`: how much of the way a cell is after this one.
static void blend_map(roil_sheet *s, sheet_map map, uint32_t cell, uint32_t slot, const float *way,
                      float part, float rate) {
    const sheet *own = &s->maps[map], *before = &s->before[map];
    float *out = mem_alloc((size_t)s->cell * s->cell * 4 * sizeof *out), *to = out;
    for (uint32_t y = 0; y < s->cell; y++)
        for (uint32_t x = 0; x < s->cell; x++, to += 4, way += 2) {
            const float at[] = {(float)x, (float)y};
            add_sample(own, cell, at[0] - part * way[0], at[1] - part * way[1], 1 - part, to);
            add_sample(before, slot, at[0] + (1 - part) * way[0], at[1] + (1 - part) * way[1], part,
                       to);
            if (map != SHEET_MOTION) continue; // what is seen goes that way besides
            to[0] += to[3] * rate * way[0];
            to[1] -= to[3] * rate * way[1];
        }
    for (uint32_t y = 0; y < s->cell; y++)
        memcpy(sheet_pixel(own, cell, 0, y), out + (size_t)y * s->cell * 4,
               (size_t)s->cell * 4 * sizeof *out);
    mem_free(out);
}

static bool dissolve(roil_sheet *s, uint32_t cell, double part) {
    const uint32_t cells = s->columns * s->rows;
    if (cell >= cells || cells - cell > s->fade)
        return err_set("cell %u is not among the last %u", cell, s->fade);
    const uint32_t slot = cell - (cells - s->fade);
    s->parts[slot] = (float)part;
    return sheet_take(s, s->before, slot, 1);
}

bool roil_sheet_dissolve(roil_sheet *s, uint32_t cell, double part) {
    return MEM_CALL(dissolve(s, cell, part));
}

bool sheet_blend(roil_sheet *s, double fps) {
    const uint32_t first = s->columns * s->rows - s->fade;
    const size_t pixels = (size_t)s->cell * s->cell;
    float *way = mem_alloc(2 * pixels * sizeof *way);
    s->flows = s->fade && (s->maps[SHEET_SHOWN].pixels || s->maps[SHEET_SCENE].pixels) &&
               optical_flow_load();
    const uint32_t middle = s->fade / 2; // where both are seen alike
    bool done = !s->flows || find_whether_alike(s, first + middle, middle, way, &s->flows);
    if (!s->flows) memset(way, 0, 2 * pixels * sizeof *way);
    for (uint32_t i = 0; done && i < s->fade; i++) {
        const float before = i ? s->parts[i - 1] : 0, after = i + 1 < s->fade ? s->parts[i + 1] : 1;
        const float rate = 0.5f * (after - before) * (float)fps / (float)s->cell;
        done = !s->flows || find_way(s, first + i, i, way);
        for (int map = 0; done && map < SHEET_MAPS; map++)
            if (s->before[map].pixels)
                blend_map(s, (sheet_map)map, first + i, i, way, s->parts[i], rate);
    }
    mem_free(way);
    return done;
}
