// The graph of the effect: passes in the order of their work, with times and pictures of what they
// write, and lines to those that read it. It is read only; clicks lead to the panel, the inspector
// and the line of the script.
#include "app/editor.h"
#include "app/label.h"
#include "app/live.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const float WIDTH = 860, HEIGHT = 460; // units, as all of these
static const float BOX = 168, PICTURE = 96, ROW = 18, PAD = 8, ACROSS = 60, DOWN = 18;
enum { TEXELS_WIDE = 152, TEXELS_HIGH = 96, MOST_NAME = 96 }; // of a picture, as in its box

typedef struct box {
    size_t column;
    float left, top, height; // units, from the graph's corner
    size_t outputs;          // images that it writes
} box;

typedef struct shown_image { // a picture of an image of the graph
    char name[MOST_NAME];
    roil_texture *texture;
    bool seen; // it holds something
} shown_image;

struct graph_view {
    roil_graph_pass *passes;
    roil_graph_link *links;
    roil_image_info *images;
    box *boxes;
    shown_image *pictures; // by image
    size_t pass_count, link_count, image_count, picture_count;
    size_t pass_capacity, link_capacity, image_capacity, box_capacity, picture_capacity;
    float scroll[2]; // units
    size_t turn;     // image that is drawn next
    uint64_t picture;
};

graph_view *graph_view_create(void) {
    return mem_alloc(sizeof(graph_view));
}

static void forget_pictures(graph_view *g, roil *r) {
    for (size_t i = 0; i < g->picture_count; i++) roil_texture_destroy(r, g->pictures[i].texture);
    g->picture_count = 0;
}

void graph_view_destroy(graph_view *g, roil *r) {
    if (!g) return;
    forget_pictures(g, r);
    mem_free(g->passes);
    mem_free(g->links);
    mem_free(g->images);
    mem_free(g->boxes);
    mem_free(g->pictures);
    mem_free(g);
}

// ---- layout -------------------------------------------------------------------------------------

static void gather(graph_view *g, roil_effect *e) {
    g->pass_count = roil_graph_passes(e, NULL, 0);
    g->link_count = roil_graph_links(e, NULL, 0);
    g->image_count = roil_images(e, NULL, 0);
    MEM_RESERVE(g->passes, g->pass_count, g->pass_capacity);
    MEM_RESERVE(g->boxes, g->pass_count, g->box_capacity);
    MEM_RESERVE(g->links, g->link_count, g->link_capacity);
    MEM_RESERVE(g->images, g->image_count, g->image_capacity);
    roil_graph_passes(e, g->passes, g->pass_count);
    roil_graph_links(e, g->links, g->link_count);
    roil_images(e, g->images, g->image_count);
}

static size_t writer_of(const graph_view *g, size_t image) {
    for (size_t i = 0; i < g->link_count; i++)
        if (g->links[i].writes && g->links[i].image == image) return g->links[i].pass;
    return g->pass_count;
}

// A pass stands to the right of all that it reads from. They come in the order of their work, so
// that one walk is enough.
static void lay_out(graph_view *g) {
    float *bottoms = mem_alloc((g->pass_count + 1) * sizeof *bottoms);
    for (size_t i = 0; i < g->pass_count; i++) g->boxes[i] = (box){.column = 0};
    for (size_t i = 0; i < g->pass_count; i++) {
        box *b = &g->boxes[i];
        for (size_t k = 0; k < g->link_count; k++) {
            const roil_graph_link *link = &g->links[k];
            if (link->pass != i) continue;
            b->outputs += link->writes;
            size_t from = link->writes ? g->pass_count : writer_of(g, link->image);
            if (from < i && g->boxes[from].column + 1 > b->column)
                b->column = g->boxes[from].column + 1;
        }
        b->height = 2 * PAD + 2 * ROW + (b->outputs ? PICTURE + PAD : 0) + (float)b->outputs * ROW;
        b->left = (float)b->column * (BOX + ACROSS);
        b->top = bottoms[b->column];
        bottoms[b->column] += b->height + DOWN;
    }
    mem_free(bottoms);
}

// ---- pictures -----------------------------------------------------------------------------------

static void match_pictures(graph_view *g, roil *r) {
    bool same = g->picture_count == g->image_count;
    for (size_t i = 0; i < g->image_count && same; i++)
        same = strcmp(g->pictures[i].name, g->images[i].name) == 0;
    if (same) return;
    forget_pictures(g, r);
    MEM_RESERVE(g->pictures, g->image_count, g->picture_capacity);
    for (size_t i = 0; i < g->image_count; i++) {
        g->pictures[i] = (shown_image){.texture = NULL};
        str_copy(g->pictures[i].name, sizeof g->pictures[i].name, g->images[i].name);
    }
    g->picture_count = g->image_count;
}

static void draw_picture(graph_view *g, live *l, size_t index) {
    shown_image *p = &g->pictures[index];
    const roil_image_info *image = &g->images[index];
    if (image->culled) return;
    if (!p->texture) p->texture = roil_texture_create(l->r, TEXELS_WIDE, TEXELS_HIGH, NULL);
    float zoom = fminf(TEXELS_WIDE / (float)image->size[0], TEXELS_HIGH / (float)image->size[1]);
    roil_texel unused;
    p->seen = p->texture && roil_inspect(l->effect,
                                         &(roil_inspection){.image = p->name,
                                                            .axis = 2,
                                                            .slice = 0.5f,
                                                            .channels = 7,
                                                            .center = {0.5f, 0.5f},
                                                            .zoom = zoom,
                                                            .cursor = {-1, -1}},
                                         p->texture, &unused);
}

// One picture at a time, round and round while frames are drawn.
void graph_view_update(live *l) {
    graph_view *g = l->graph;
    if (!l->session.graph || !l->effect) return;
    gather(g, l->effect);
    lay_out(g);
    match_pictures(g, l->r);
    if (g->picture != l->pictures) g->turn = 0;
    g->picture = l->pictures;
    if (g->turn < g->picture_count) draw_picture(g, l, g->turn++);
}

bool graph_view_busy(const live *l) {
    return l->session.graph && l->effect && l->graph->turn < l->graph->picture_count;
}

// ---- drawing ------------------------------------------------------------------------------------

typedef struct drawing {
    live *l;
    graph_view *g;
    const ui_canvas *canvas;
    float left, top; // of the graph's corner, pixels
    const char *hint;
    char hint_text[2048];
} drawing;

static bool is_over(const drawing *d, ui_rect r) {
    const ui_canvas *c = d->canvas;
    return c->hovered && c->x >= r.left && c->x < r.right && c->y >= r.top && c->y < r.bottom;
}

static bool is_clicked(const drawing *d, ui_rect r) {
    return is_over(d, r) && d->canvas->released && d->l->slipped <= 4 * ui_scale();
}

static ui_rect place_of(const drawing *d, const box *b) {
    float s = ui_scale(), left = d->left + b->left * s, top = d->top + b->top * s;
    return (ui_rect){left, top, left + BOX * s, top + b->height * s};
}

static void draw_links(const drawing *d) {
    const graph_view *g = d->g;
    for (size_t i = 0; i < g->link_count; i++) {
        size_t to = g->links[i].pass, from = writer_of(g, g->links[i].image);
        if (g->links[i].writes || from == g->pass_count || from == to) continue;
        ui_rect a = place_of(d, &g->boxes[from]), b = place_of(d, &g->boxes[to]);
        bool lit = is_over(d, a) || is_over(d, b);
        float s = ui_scale(), y0 = a.top + (PAD + ROW) * s, y1 = b.top + (PAD + ROW) * s;
        float x0 = a.right, x1 = b.left, bend = fmaxf((x1 - x0) / 2, 12 * s);
        float line[2 * 17];
        for (int k = 0; k <= 16; k++) { // a cubic curve that leaves and arrives level
            float t = (float)k / 16, u = 1 - t;
            line[2 * k] = u * u * u * x0 + 3 * u * u * t * (x0 + bend) +
                          3 * u * t * t * (x1 - bend) + t * t * t * x1;
            line[2 * k + 1] = u * u * (u + 3 * t) * y0 + t * t * (t + 3 * u) * y1;
        }
        ui_polyline(line, 17, ui_rgba(lit ? UI_ACCENT : UI_LINE, 1), (lit ? 2 : 1.4f) * s);
    }
}

static bool text_link(drawing *d, float x, float y, float width, const char *text, ui_color color) {
    ui_rect at = {x, y, x + width, y + ROW * ui_scale()};
    bool over = is_over(d, at);
    label_within(x, y, width, ui_rgba(over ? UI_ACCENT : color, 1), text);
    return is_clicked(d, at);
}

static void open_line(live *l, const roil_graph_pass *pass) {
    log_write(LOG_DEBUG, "live: edits %s:%d", pass->file, pass->line);
    if (!editor_open(pass->file, pass->line))
        live_notice(l, "%s", roil_error());
    else
        live_notice(l, "Opened line %d of %s", pass->line, path_name(pass->file));
}

static void draw_head(drawing *d, const roil_graph_pass *pass, ui_rect at) {
    float s = ui_scale(), width = at.right - at.left - 2 * PAD * s, y = at.top + PAD * s;
    char text[128];
    double ms = performance_time(d->l->performance, pass->name);
    if (text_link(d, at.left + PAD * s, y, width, pass->name, pass->culled ? UI_DIM : UI_TEXT)) {
        char search[128];
        snprintf(search, sizeof search, "%s.", pass->pass);
        panel_find(d->l, search);
        log_write(LOG_DEBUG, "live: found %s", search);
    }
    snprintf(text, sizeof text, pass->culled ? "not run" : ms >= 0 ? "%.2f ms" : "", ms);
    ui_label(at.left + PAD * s, y + ROW * s, ui_rgba(UI_DIM, 1), text);
    ui_mark("name", (ui_rect){at.left + PAD * s, y, at.left + PAD * s + width, y + ROW * s});
    if (ms >= 0) ui_mark("time", (ui_rect){at.left, y + ROW * s, at.right, y + 2 * ROW * s});
    if (!pass->file) return;
    snprintf(text, sizeof text, "line %d", pass->line);
    float wide = ui_text_width(text);
    ui_mark("line",
            (ui_rect){at.right - PAD * s - wide, y + ROW * s, at.right - PAD * s, y + 2 * ROW * s});
    if (text_link(d, at.right - PAD * s - wide, y + ROW * s, wide + s, text, UI_DIM))
        open_line(d->l, pass);
}

static void draw_outputs(drawing *d, size_t pass, ui_rect at) {
    graph_view *g = d->g;
    float s = ui_scale(), x = at.left + PAD * s, width = at.right - at.left - 2 * PAD * s;
    float y = at.top + (2 * PAD + 2 * ROW) * s;
    const shown_image *shown = NULL;
    ui_rect picture = {x, y, at.right - PAD * s, y + PICTURE * s};
    y = picture.bottom + PAD * s;
    for (size_t i = 0; i < g->link_count; i++) {
        if (g->links[i].pass != pass || !g->links[i].writes) continue;
        const roil_image_info *image = &g->images[g->links[i].image];
        const shown_image *own = &g->pictures[g->links[i].image];
        const char *dot = strrchr(image->name, '.');
        ui_rect row = {x, y, x + width, y + ROW * s};
        if (own->seen && (!shown || is_over(d, row))) shown = own;
        if (text_link(d, x, y, width, dot ? dot + 1 : image->name, UI_DIM) && !image->culled) {
            str_copy(d->l->session.image, sizeof d->l->session.image, image->name);
            d->l->session.inspector = true;
        }
        ui_mark(image->name, row);
        y += ROW * s;
    }
    ui_fill(picture, ui_rgba(UI_FIELD, 1), 2 * s);
    if (shown) ui_image(picture, shown->texture);
}

static void draw_box(drawing *d, size_t i) {
    const roil_graph_pass *pass = &d->g->passes[i];
    const box *b = &d->g->boxes[i];
    float s = ui_scale();
    ui_rect at = place_of(d, b);
    const ui_rect *view = &d->canvas->area;
    if (at.bottom < view->top || at.top > view->bottom || at.right < view->left ||
        at.left > view->right)
        return;
    ui_fill(at, ui_rgba(UI_PANEL, 1), 5 * s);
    ui_frame(at, ui_rgba(is_over(d, at) ? UI_ACCENT : UI_LINE, 1), 5 * s, s);
    ui_push(pass->name);
    draw_head(d, pass, at);
    if (b->outputs) draw_outputs(d, i, at);
    ui_pop();
    ui_rect head = {at.left, at.top, at.right, at.top + (PAD + ROW) * s};
    if (!is_over(d, head)) return;
    char *fields = roil_graph_fields(d->l->effect, pass->pass);
    if (fields && fields[0]) {
        str_copy(d->hint_text, sizeof d->hint_text, fields);
        d->hint = d->hint_text;
    }
    roil_free(fields);
}

static void draw_graph(live *l) {
    graph_view *g = l->graph;
    ui_canvas c = ui_canvas_begin("graph", 0, 0);
    float s = ui_scale();
    if (c.pressed)
        l->slipped = 0;
    else if (c.held)
        l->slipped += fabsf(c.dx) + fabsf(c.dy);
    if ((c.held || c.middle_held) && !c.pressed) { // that was the way to where it was pressed
        g->scroll[0] += c.dx / s;
        g->scroll[1] += c.dy / s;
    }
    if (c.shift)
        g->scroll[0] += c.wheel * 48;
    else
        g->scroll[1] += c.wheel * 48;
    drawing d = {.l = l,
                 .g = g,
                 .canvas = &c,
                 .left = c.area.left + (PAD + g->scroll[0]) * s,
                 .top = c.area.top + (PAD + g->scroll[1]) * s};
    ui_fill(c.area, ui_rgba(UI_FIELD, 1), 0);
    draw_links(&d);
    for (size_t i = 0; i < g->pass_count; i++) draw_box(&d, i);
    ui_canvas_end();
    if (d.hint) ui_tooltip(d.hint);
}

void graph_view_draw(live *l) {
    if (!l->session.graph) return;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, false);
    if (ui_window_begin("Graph", &l->session.graph, where, false)) {
        if (!l->effect || !l->graph->pass_count)
            ui_text_color(UI_DIM, "There is no graph yet.");
        else
            draw_graph(l);
    }
    ui_window_end();
}
