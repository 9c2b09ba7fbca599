// What fills space under the pointer: the point that one sees there, and what is at it.
#include "app/handles.h"
#include "app/label.h"
#include "base/log.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const float PADDING = 8, GAP = 16, FROM = 16; // units; the last: from the pointer

// Asks again where the pointer, or the picture, is another.
static void ask(live *l, const lens *view, const ui_canvas *c) {
    live_probe *p = &l->probe;
    const ui_rect *r = &view->picture;
    float x = (c->x - r->left) / fmaxf(r->right - r->left, 1);
    float y = (c->y - r->top) / fmaxf(r->bottom - r->top, 1);
    if (p->of == l->effect && p->picture == l->pictures && p->x == x && p->y == y) return;
    p->of = l->effect;
    p->picture = l->pictures;
    p->x = x;
    p->y = y;
    p->why[0] = '\0';
    if (!roil_probe(l->effect, x, y, &p->found)) {
        str_copy(p->why, sizeof p->why, roil_error());
        return;
    }
    log_write(LOG_DEBUG, "live: probed %g,%g,%g density %g", (double)p->found.at[0],
              (double)p->found.at[1], (double)p->found.at[2],
              p->found.found ? (double)p->found.density : 0);
}

typedef struct row {
    char name[96], value[96];
} row;

static size_t fill_rows(const live_probe *p, row out[2 + ROIL_PROBE_VALUES]) {
    const roil_probed *f = &p->found;
    size_t count = 0;
    if (p->why[0] || !f->found) {
        str_copy(out[0].name, sizeof out[0].name, p->why[0] ? p->why : "nothing is here");
        out[0].value[0] = '\0';
        return 1;
    }
    out[count] = (row){.name = "at"};
    snprintf(out[count++].value, sizeof out->value, "%.3g, %.3g, %.3g m", (double)f->at[0],
             (double)f->at[1], (double)f->at[2]);
    out[count] = (row){.name = "density"};
    snprintf(out[count++].value, sizeof out->value, "%.4g 1/m", (double)f->density);
    for (size_t i = 0; i < f->count; i++, count++) {
        const float *v = f->values[i].value;
        str_copy(out[count].name, sizeof out->name, f->values[i].name);
        if (f->values[i].components == 1)
            snprintf(out[count].value, sizeof out->value, "%.4g", (double)v[0]);
        else
            snprintf(out[count].value, sizeof out->value, "%.3g, %.3g, %.3g", (double)v[0],
                     (double)v[1], (double)v[2]);
    }
    return count;
}

void probe_draw(live *l, const ui_canvas *c) {
    lens view;
    row rows[2 + ROIL_PROBE_VALUES];
    if (!l->session.probe || !c->hovered || c->held || !view_lens(l, &view)) return;
    ask(l, &view, c);
    float s = ui_scale(), names = 0, values = 0, high = label_height() + 4 * s;
    size_t count = fill_rows(&l->probe, rows);
    for (size_t i = 0; i < count; i++) {
        names = fmaxf(names, ui_text_width(rows[i].name));
        values = fmaxf(values, ui_text_width(rows[i].value));
    }
    float width = names + (values > 0 ? values + GAP * s : 0) + 2 * PADDING * s;
    float height = (float)count * high + 2 * PADDING * s - 4 * s;
    float left = c->x + FROM * s, top = c->y + FROM * s;
    if (left + width > l->view.right) left = fmaxf(c->x - FROM * s - width, l->view.left);
    if (top + height > l->view.bottom) top = fmaxf(c->y - FROM * s - height, l->view.top);
    ui_rect box = {left, top, left + width, top + height};
    ui_fill(box, ui_rgba(UI_PANEL, 0.9f), 6 * s);
    ui_mark("probe", box);
    for (size_t i = 0; i < count; i++) {
        float y = top + PADDING * s + (float)i * high;
        ui_label(left + PADDING * s, y, ui_rgba(rows[i].value[0] ? UI_DIM : UI_TEXT, 1),
                 rows[i].name);
        label_right(left + width - PADDING * s, y, ui_rgba(UI_TEXT, 1), rows[i].value);
    }
    float at[2];
    if (l->probe.found.found && !l->probe.why[0] && lens_project(&view, l->probe.found.at, at)) {
        ui_ring(at[0], at[1], 4 * s, 0xb0000000, 3 * s);
        ui_ring(at[0], at[1], 4 * s, ui_rgba(UI_TEXT, 1), 1.5f * s);
    }
}
