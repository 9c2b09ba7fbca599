#include "roil/redraw.h"
#include "base/hash.h"
#include "base/memory.h"
#include "roil/view.h"
#include <math.h>
#include <string.h>

static const uint64_t ODD = 0x9e3779b97f4a7c15;

// ---- boxes --------------------------------------------------------------------------------------

static bool is_empty(redraw_box b) {
    return b.left >= b.right || b.top >= b.bottom;
}

static bool do_meet(redraw_box a, redraw_box b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

static redraw_box joined(redraw_box a, redraw_box b) {
    return (redraw_box){a.left < b.left ? a.left : b.left, a.top < b.top ? a.top : b.top,
                        a.right > b.right ? a.right : b.right,
                        a.bottom > b.bottom ? a.bottom : b.bottom};
}

static redraw_box common(redraw_box a, redraw_box b) {
    return (redraw_box){a.left > b.left ? a.left : b.left, a.top > b.top ? a.top : b.top,
                        a.right < b.right ? a.right : b.right,
                        a.bottom < b.bottom ? a.bottom : b.bottom};
}

static uint64_t size_of(redraw_box b) {
    return (uint64_t)(b.right - b.left) * (b.bottom - b.top);
}

static uint32_t first_tile(float at) {
    return at > 0 ? (uint32_t)((at < 1e6f ? at : 1e6f) / REDRAW_TILE) : 0;
}

// The tile behind that of `at`, at most `most`. What is no number is far.
static uint32_t end_tile(float at, uint32_t most) {
    if (at < 0) return 0;
    uint32_t end = at < 1e6f ? (uint32_t)(at / REDRAW_TILE) + 1 : most;
    return end < most ? end : most;
}

static redraw_box box_of(const redraw *d, float left, float top, float right, float bottom) {
    return (redraw_box){first_tile(left), first_tile(top), end_tile(right, d->columns),
                        end_tile(bottom, d->rows)};
}

static float least(float a, float b, float c) {
    float low = a < b ? a : b;
    return low < c ? low : c;
}

static redraw_box triangle_box(const redraw *d, const roil_vertex v[3]) {
    return box_of(d, least(v[0].x, v[1].x, v[2].x), least(v[0].y, v[1].y, v[2].y),
                  -least(-v[0].x, -v[1].x, -v[2].x), -least(-v[0].y, -v[1].y, -v[2].y));
}

static gpu_area pixels_of(const redraw *d, redraw_box b) {
    uint32_t x = b.left * REDRAW_TILE, y = b.top * REDRAW_TILE;
    uint32_t right = b.right * REDRAW_TILE, bottom = b.bottom * REDRAW_TILE;
    return (gpu_area){x, y, (right < d->width ? right : d->width) - x,
                      (bottom < d->height ? bottom : d->height) - y};
}

// Clips to the canvas in whole pixels. False when nothing is left.
static bool clip(const redraw *d, const float clip[4], gpu_area *out) {
    float right = fminf(rintf(clip[2]), (float)d->width), left = fmaxf(rintf(clip[0]), 0);
    float bottom = fminf(rintf(clip[3]), (float)d->height), top = fmaxf(rintf(clip[1]), 0);
    if (!(left < right && top < bottom)) return false;
    *out = (gpu_area){(uint32_t)left, (uint32_t)top, (uint32_t)(right - left),
                      (uint32_t)(bottom - top)};
    return true;
}

// False when they have nothing in common.
static bool cut(gpu_area *a, gpu_area b) {
    uint32_t right = a->x + a->width < b.x + b.width ? a->x + a->width : b.x + b.width;
    uint32_t bottom = a->y + a->height < b.y + b.height ? a->y + a->height : b.y + b.height;
    uint32_t x = a->x > b.x ? a->x : b.x, y = a->y > b.y ? a->y : b.y;
    if (x >= right || y >= bottom) return false;
    *a = (gpu_area){x, y, right - x, bottom - y};
    return true;
}

// ---- hashes -------------------------------------------------------------------------------------

static void add(redraw *d, redraw_box b, uint64_t hash) {
    for (uint32_t y = b.top; y < b.bottom; y++)
        for (uint32_t x = b.left; x < b.right; x++) {
            uint64_t *tile = &d->now[(size_t)y * d->columns + x];
            *tile = (*tile ^ hash) * ODD;
        }
}

static void add_below(redraw *d, const redraw_below *below) {
    memset(d->now, 0, (size_t)d->columns * d->rows * sizeof *d->now);
    add(d, (redraw_box){0, 0, d->columns, d->rows}, hash64(&below->ground, sizeof below->ground));
    for (int i = 0; i < 2; i++) {
        const int32_t *place = below->places[i];
        if (place[2] <= 0 || place[3] <= 0) continue;
        float left = (float)place[0], top = (float)place[1];
        add(d, box_of(d, left, top, left + (float)place[2], top + (float)place[3]),
            hash64(&below->pictures, sizeof below->pictures));
    }
}

// What the look of a triangle depends on, without gaps.
typedef struct look {
    roil_vertex corners[3];
    gpu_area clip;
    uint32_t unused;
    uint64_t texture;
} look;
_Static_assert(sizeof(look) == 3 * sizeof(roil_vertex) + sizeof(gpu_area) + 12, "it is hashed");

// Notes the box of each triangle, cut to what is seen of it.
static void add_draw(redraw *d, const roil_picture *p, const roil_draw *draw, redraw_box *boxes) {
    look l = {.texture = draw->texture ? draw->texture->version : 0};
    bool seen = clip(d, draw->clip, &l.clip);
    redraw_box whole = {l.clip.x / REDRAW_TILE, l.clip.y / REDRAW_TILE,
                        end_tile((float)(l.clip.x + l.clip.width) - 0.5f, d->columns),
                        end_tile((float)(l.clip.y + l.clip.height) - 0.5f, d->rows)};
    for (uint32_t i = 0; i + 2 < draw->count; i += 3) {
        redraw_box *box = &boxes[i / 3];
        for (uint32_t k = 0; k < 3; k++)
            l.corners[k] = p->vertices[p->indices[draw->first + i + k]];
        *box = seen ? common(triangle_box(d, l.corners), whole) : (redraw_box){0};
        if (!is_empty(*box)) add(d, *box, hash64(&l, sizeof l));
    }
}

static size_t triangles_of(const roil_picture *p) {
    size_t count = 0;
    for (size_t i = 0; i < p->draw_count; i++) count += p->draws[i].count / 3;
    return count;
}

// ---- areas --------------------------------------------------------------------------------------

typedef struct areas {
    redraw_box boxes[REDRAW_AREAS + 1];
    size_t count;
} areas;

static void drop(areas *a, size_t i) {
    a->boxes[i] = a->boxes[--a->count];
}

// Areas that overlap become one: what is half transparent must be drawn once.
static void join_what_meets(areas *a) {
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = i + 1; k < a->count; k++) {
            if (!do_meet(a->boxes[i], a->boxes[k])) continue;
            a->boxes[i] = joined(a->boxes[i], a->boxes[k]);
            drop(a, k);
            i = k = 0; // it may meet others now
        }
}

// Joins the two that grow least by it.
static void join_nearest(areas *a) {
    size_t first = 0, second = 1;
    uint64_t least = UINT64_MAX;
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = i + 1; k < a->count; k++) {
            uint64_t more = size_of(joined(a->boxes[i], a->boxes[k])) - size_of(a->boxes[i]) -
                            size_of(a->boxes[k]);
            if (more >= least) continue;
            least = more;
            first = i;
            second = k;
        }
    a->boxes[first] = joined(a->boxes[first], a->boxes[second]);
    drop(a, second);
    join_what_meets(a);
}

// A run of tiles in a row, below the same run of the row above or by itself.
static void add_run(areas *a, redraw_box run) {
    for (size_t i = 0; i < a->count; i++) {
        redraw_box *b = &a->boxes[i];
        if (b->left != run.left || b->right != run.right || b->bottom != run.top) continue;
        b->bottom = run.bottom;
        return;
    }
    a->boxes[a->count++] = run;
    if (a->count > REDRAW_AREAS) join_nearest(a);
}

static bool is_other(const redraw *d, uint32_t x, uint32_t y) {
    size_t tile = (size_t)y * d->columns + x;
    return !d->known || d->now[tile] != d->before[tile];
}

static void find_areas(const redraw *d, areas *a) {
    for (uint32_t y = 0; y < d->rows; y++)
        for (uint32_t x = 0; x < d->columns; x++) {
            uint32_t left = x;
            while (x < d->columns && is_other(d, x, y)) x++;
            if (x > left) add_run(a, (redraw_box){left, y, x, y + 1});
        }
    join_what_meets(a);
}

// ---- what is in them ----------------------------------------------------------------------------

static void choose(redraw *d, const roil_picture *p, redraw_box area, gpu_area pixels) {
    const redraw_box *boxes = d->boxes;
    for (size_t i = 0; i < p->draw_count; i++) {
        const roil_draw *draw = &p->draws[i];
        redraw_draw out = {.of = i, .first = (uint32_t)d->index_count};
        if (clip(d, draw->clip, &out.area) && cut(&out.area, pixels)) {
            MEM_RESERVE(d->indices, d->index_count + draw->count, d->index_capacity);
            for (uint32_t k = 0; k + 2 < draw->count; k += 3) {
                if (!do_meet(boxes[k / 3], area)) continue;
                memcpy(d->indices + d->index_count, p->indices + draw->first + k,
                       3 * sizeof *d->indices);
                d->index_count += 3;
            }
        }
        boxes += draw->count / 3;
        out.count = (uint32_t)d->index_count - out.first;
        if (!out.count) continue;
        MEM_RESERVE(d->draws, d->draw_count + 1, d->draw_capacity);
        d->draws[d->draw_count++] = out;
    }
}

static void fit(redraw *d, uint32_t width, uint32_t height) {
    if (d->width != width || d->height != height) d->known = false;
    d->width = width;
    d->height = height;
    d->columns = (width + REDRAW_TILE - 1) / REDRAW_TILE;
    d->rows = (height + REDRAW_TILE - 1) / REDRAW_TILE;
    size_t tiles = (size_t)d->columns * d->rows;
    MEM_RESERVE(d->before, tiles, d->before_capacity);
    MEM_RESERVE(d->now, tiles, d->now_capacity);
}

void redraw_find(redraw *d, const roil_picture *p, const redraw_below *below) {
    areas found = {.count = 0};
    fit(d, p->width, p->height);
    MEM_RESERVE(d->boxes, triangles_of(p), d->box_capacity);
    add_below(d, below);
    redraw_box *boxes = d->boxes;
    for (size_t i = 0; i < p->draw_count; i++) {
        add_draw(d, p, &p->draws[i], boxes);
        boxes += p->draws[i].count / 3;
    }
    find_areas(d, &found);
    d->area_count = found.count;
    d->draw_count = d->index_count = 0;
    for (size_t i = 0; i < found.count; i++) {
        d->areas[i] = pixels_of(d, found.boxes[i]);
        choose(d, p, found.boxes[i], d->areas[i]);
    }
    d->known = false; // until it has been drawn
}

void redraw_keep(redraw *d) {
    uint64_t *tiles = d->before;
    size_t capacity = d->before_capacity;
    d->before = d->now;
    d->before_capacity = d->now_capacity;
    d->now = tiles;
    d->now_capacity = capacity;
    d->known = true;
}

void redraw_forget(redraw *d) {
    d->known = false;
}

void redraw_free(redraw *d) {
    mem_free(d->before);
    mem_free(d->now);
    mem_free(d->draws);
    mem_free(d->indices);
    mem_free(d->boxes);
    *d = (redraw){0};
}
