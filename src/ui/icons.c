// Icons, each of a few triangles, bars and arcs on a grid of 16 units.
#include "ui/parts.h"
#include <math.h>

typedef struct grid {
    float left, top, unit;
    uint32_t color;
} grid;

static float at_x(const grid *g, float x) {
    return g->left + x * g->unit;
}
static float at_y(const grid *g, float y) {
    return g->top + y * g->unit;
}

static void bar(const grid *g, float left, float top, float right, float bottom) {
    ui_fill((ui_rect){at_x(g, left), at_y(g, top), at_x(g, right), at_y(g, bottom)}, g->color,
            g->unit * 0.6f);
}

// Points right, from x to x + width; left when the width is negative.
static void arrow(const grid *g, float x, float width, float half) {
    ui_triangle(at_x(g, x), at_y(g, 8 - half), at_x(g, x + width), at_y(g, 8), at_x(g, x),
                at_y(g, 8 + half), g->color);
}

static void arc(const grid *g, float radius, float from, float to) {
    enum { POINTS = 24 };
    float xy[POINTS * 2];
    for (int i = 0; i < POINTS; i++) {
        float a = from + (to - from) * (float)i / (POINTS - 1);
        xy[2 * i] = at_x(g, 8 + radius * cosf(a));
        xy[2 * i + 1] = at_y(g, 8 + radius * sinf(a));
    }
    ui_polyline(xy, POINTS, g->color, 1.6f * g->unit);
}

static void head(const grid *g, float x, float y, float dx,
                 float dy) { // of an arc, towards (dx, dy)
    const float half = 3, length = 3.4f;
    ui_triangle(at_x(g, x - dy * half), at_y(g, y + dx * half), at_x(g, x + dx * length),
                at_y(g, y + dy * length), at_x(g, x + dy * half), at_y(g, y - dx * half), g->color);
}

static void stroke(const grid *g, float left, float top, float right, float bottom) {
    ui_line(at_x(g, left), at_y(g, top), at_x(g, right), at_y(g, bottom), g->color, 1.6f * g->unit);
}

static void sheet(const grid *g, float left, float top) {
    ui_frame((ui_rect){at_x(g, left), at_y(g, top), at_x(g, left + 7), at_y(g, top + 8.5f)},
             g->color, 1.5f * g->unit, 1.4f * g->unit);
}

void draw_icon(int icon, ui_rect area, uint32_t color) {
    float width = area.right - area.left, height = area.bottom - area.top;
    float side = fminf(width, height);
    grid g = {area.left + (width - side) / 2, area.top + (height - side) / 2, side / 16, color};
    switch (icon) {
    case UI_ICON_PLAY:
        arrow(&g, 4, 9.5f, 5.5f);
        break;
    case UI_ICON_PAUSE:
        bar(&g, 4, 3, 6.8f, 13);
        bar(&g, 9.2f, 3, 12, 13);
        break;
    case UI_ICON_BACK:
        arrow(&g, 9, -6, 4);
        bar(&g, 10.6f, 4, 12.4f, 12);
        break;
    case UI_ICON_FORWARD:
        arrow(&g, 7, 6, 4);
        bar(&g, 3.6f, 4, 5.4f, 12);
        break;
    case UI_ICON_START:
        bar(&g, 2.6f, 4, 4.4f, 12);
        arrow(&g, 9, -4.5f, 4);
        arrow(&g, 13.5f, -4.5f, 4);
        break;
    case UI_ICON_END:
        arrow(&g, 2.5f, 4.5f, 4);
        arrow(&g, 7, 4.5f, 4);
        bar(&g, 11.6f, 4, 13.4f, 12);
        break;
    case UI_ICON_LOOP:
        arc(&g, 4.8f, 3.4f, 5.6f);
        head(&g, 11.5f, 4.7f, 0.65f, 0.76f);
        arc(&g, 4.8f, 0.26f, 2.46f);
        head(&g, 4.5f, 11.3f, -0.65f, -0.76f);
        break;
    case UI_ICON_RESET:
        arc(&g, 4.8f, -2.2f, 2.6f);
        head(&g, 5.4f, 4, -0.8f, 0.6f);
        break;
    case UI_ICON_COPY:
        sheet(&g, 3, 2.5f);
        sheet(&g, 6, 5);
        break;
    case UI_ICON_REMOVE:
        stroke(&g, 4, 4, 12, 12);
        stroke(&g, 4, 12, 12, 4);
        break;
    }
}
