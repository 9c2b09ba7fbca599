// Handles over the picture: lights, the sun, shapes, what is born, meshes, nodes, boxes of volumes
// and keys of paths can be dragged. What moves is a control, as in the panel (live_set), so that it
// can be undone and written into the file.
#include "app/handles.h"
#include "app/label.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 512, PATH_POINTS = 64, NONE = -1 };
static const float REACH = 9, DOT = 5, ARROW = 62, ARROW_REACH = 6; // units
static const float SUN_FAR = 0.35f; // of the sun's sign from the target, of the eye's distance
static const uint32_t DARK = 0xb0000000;

static const uint32_t colors[ROIL_THINGS] = {
    [ROIL_CAMERA] = 0xff658aff,    [ROIL_SUN] = 0xff30c0ff,    [ROIL_LIGHT] = 0xff4ad5ff,
    [ROIL_SHAPE] = 0xffffc85e,     [ROIL_MESH] = 0xff7de39b,   [ROIL_NODE] = 0xffffa6c9,
    [ROIL_PARTICLES] = 0xffe97dff, [ROIL_VOLUME] = 0xfff0f0f0,
};
static const uint32_t axis_colors[3] = {0xff4a4af0, 0xff4ac85a, 0xfff08a4a};

struct handles {
    roil_handle list[MOST];
    size_t count;
    float eye[3], clear;      // of the view, and how far from it what is in its way must be (m)
    lens held;                // the view when a drag began: a camera may move with its own keys
    float middle[3], sun_far; // of the sun's dome (m)
    int hovered, chosen;      // indices; NONE
    int axis;                 // that the chosen one is dragged along; NONE: none
    int hovered_axis;
    bool dragging;
    float from[3], to[3]; // where the dragged one was, and where it is to go
    float grab[2];        // from the pointer to its point (pixels)
    float told[3];        // where it was put last
    char control[96];     // of the chosen one, which a reload may move in the list
    size_t key;
    char part[32];
};

handles *handles_create(void) {
    handles *h = mem_alloc(sizeof *h);
    h->hovered = h->chosen = h->axis = h->hovered_axis = NONE;
    return h;
}

void handles_destroy(handles *h) {
    mem_free(h);
}

// ---- the list -----------------------------------------------------------------------------------

static bool is_same(const handles *h, const roil_handle *a) {
    return a->control && strcmp(a->control, h->control) == 0 && a->key == h->key &&
           strcmp(a->part, h->part) == 0;
}

static void choose(handles *h, int index) {
    h->chosen = index;
    if (index == NONE) return;
    const roil_handle *chosen = &h->list[index];
    str_copy(h->control, sizeof h->control, chosen->control ? chosen->control : "");
    str_copy(h->part, sizeof h->part, chosen->part);
    h->key = chosen->key;
}

// The sun stands on a dome around what the camera looks at; everything else where it is.
static void gather(live *l) {
    handles *h = l->handles;
    roil_camera camera;
    int chosen = NONE;
    if (!roil_get_camera(l->effect, &camera)) return;
    h->count = roil_handles(l->effect, h->list, MOST);
    h->count = h->count < MOST ? h->count : MOST;
    if (!h->dragging) {
        memcpy(h->middle, camera.target, sizeof h->middle);
        h->sun_far = near_distance(&camera) * SUN_FAR;
    }
    memcpy(h->eye, camera.eye, sizeof h->eye);
    h->clear = 0.02f * camera.distance;
    for (size_t i = 0; i < h->count; i++) {
        roil_handle *one = &h->list[i];
        if (h->chosen != NONE && is_same(h, one)) chosen = (int)i;
        if (one->thing != ROIL_SUN) continue;
        glm_vec3_scale(one->at, h->sun_far, one->at);
        glm_vec3_add(one->at, h->middle, one->at);
    }
    h->chosen = chosen;
    if (chosen == NONE) h->dragging = false;
}

// A camera that one looks through lies in the eye, and so may keys of its path.
static bool is_seen(const handles *h, size_t i) {
    const roil_handle *one = &h->list[i];
    return one->thing != ROIL_CAMERA || (h->dragging && (int)i == h->chosen) ||
           glm_vec3_distance((float *)(uintptr_t)one->at, (float *)(uintptr_t)h->eye) > h->clear;
}

// ---- what is under the pointer ------------------------------------------------------------------

static float distance_to(float x, float y, const float line[4]) {
    float dx = line[2] - line[0], dy = line[3] - line[1], square = dx * dx + dy * dy;
    float t = square > 0 ? ((x - line[0]) * dx + (y - line[1]) * dy) / square : 0;
    t = clampf(t, 0, 1);
    return hypotf(x - line[0] - t * dx, y - line[1] - t * dy);
}

// An arrow has the same length in the window wherever it is.
static bool arrow_of(const lens *view, const roil_handle *one, int axis, float out[4]) {
    vec3 end;
    glm_vec3_copy((float *)(uintptr_t)one->at, end);
    end[axis] += ARROW * ui_scale() / lens_pixels(view, one->at);
    return lens_project_line(view, one->at, end, out);
}

static bool has_arrows(const roil_handle *one) {
    return one->control && !one->along && one->thing != ROIL_SUN;
}

static void find_hovered(handles *h, const lens *view, const ui_canvas *c) {
    float nearest = REACH * ui_scale(), at[2], line[4];
    h->hovered = h->hovered_axis = NONE;
    if (!c->hovered) return;
    for (size_t i = 0; i < h->count; i++) {
        if (!is_seen(h, i) || !lens_project(view, h->list[i].at, at)) continue;
        float far = hypotf(at[0] - c->x, at[1] - c->y);
        if (!h->list[i].control) far += 1; // what can be moved comes first
        if (far >= nearest) continue;
        nearest = far;
        h->hovered = (int)i;
    }
    if (h->hovered != NONE || h->chosen == NONE || !has_arrows(&h->list[h->chosen])) return;
    for (int axis = 0; axis < 3; axis++)
        if (arrow_of(view, &h->list[h->chosen], axis, line) &&
            distance_to(c->x, c->y, line) < ARROW_REACH * ui_scale())
            h->hovered_axis = axis;
}

// ---- dragging -----------------------------------------------------------------------------------

static void snap(float at[3], float step, int axis) {
    for (int i = 0; i < 3; i++)
        if (axis == NONE || axis == i) at[i] = roundf(at[i] / step) * step;
}

static void find_goal(handles *h, const live *l, const lens *view, const ui_canvas *c) {
    const roil_handle *one = &h->list[h->chosen];
    float x = c->x + h->grab[0], y = c->y + h->grab[1];
    vec3 way = {0, 0, 0}, goal;
    bool found = false;
    if (one->thing == ROIL_SUN) {
        bool far = lens_depth(view, h->from) > lens_depth(view, h->middle);
        lens_on_sphere(view, x, y, h->middle, h->sun_far, far, goal);
        found = true;
    } else if (one->along) {
        found = lens_on_line(view, x, y, h->from, one->line, goal);
    } else if (h->axis != NONE) {
        way[h->axis] = 1;
        found = lens_on_line(view, x, y, h->from, way, goal);
    } else if (c->shift) {
        way[2] = 1;
        found = lens_on_plane(view, x, y, h->from, way, goal);
    } else {
        found = lens_on_plane(view, x, y, h->from, view->forward, goal);
    }
    if (!found) return;
    if (c->control && one->thing != ROIL_SUN && !one->along)
        snap(goal, ground_step(l) / 2, h->axis);
    if (c->control && one->along) {
        float length = one->radius + glm_vec3_dot(goal, (float *)(uintptr_t)one->line) -
                       glm_vec3_dot(h->from, (float *)(uintptr_t)one->line);
        float rounded = roundf(length / (ground_step(l) / 2)) * ground_step(l) / 2;
        glm_vec3_muladds((float *)(uintptr_t)one->line, rounded - length, goal);
    }
    memcpy(h->to, goal, sizeof h->to);
}

static void set_control(live *l, const char *name, bool second, const float at[3]) {
    char *text = roil_handle_text(l->effect, (size_t)l->handles->chosen, second, at);
    if (text)
        live_set(l, name, text);
    else
        live_notice(l, "%s", roil_error());
    roil_free(text);
}

// Sets the control of what is dragged to where it is to go.
static void put(live *l) {
    handles *h = l->handles;
    const roil_handle *one = &h->list[h->chosen];
    vec3 at;
    if (memcmp(h->told, h->to, sizeof h->to) == 0) return;
    memcpy(h->told, h->to, sizeof h->to);
    glm_vec3_copy(h->to, at);
    if (one->thing == ROIL_SUN) {
        glm_vec3_sub(at, h->middle, at);
        if (glm_vec3_norm(at) < 1e-6f) return;
        glm_vec3_normalize(at);
    }
    char second[96]; // setting the first one lists the handles anew
    bool both = one->second && str_copy(second, sizeof second, one->second);
    set_control(l, h->control, false, at);
    if (both) set_control(l, second, true, at);
}

static void begin(handles *h, const lens *view, const ui_canvas *c) {
    if (h->hovered != NONE) choose(h, h->hovered);
    h->axis = h->hovered != NONE ? NONE : h->hovered_axis;
    const roil_handle *one = &h->list[h->chosen];
    float at[2];
    if (!one->control || !lens_project(view, one->at, at)) return;
    h->dragging = true;
    h->held = *view;
    h->grab[0] = at[0] - c->x;
    h->grab[1] = at[1] - c->y;
    memcpy(h->from, one->at, sizeof h->from);
    memcpy(h->to, one->at, sizeof h->to);
    memcpy(h->told, one->at, sizeof h->told);
}

bool handles_input(live *l, const ui_canvas *c) {
    handles *h = l->handles;
    lens view;
    if (!l->session.handles || !view_lens(l, &view)) {
        h->dragging = false;
        return false;
    }
    gather(l);
    if (!h->dragging) find_hovered(h, &view, c);
    if (c->pressed && (h->hovered != NONE || h->hovered_axis != NONE))
        begin(h, &view, c);
    else if (c->pressed)
        choose(h, NONE);
    bool mine = h->dragging || (h->hovered != NONE && c->held);
    if (!h->dragging) return mine;
    const bool structural = h->list[h->chosen].structural;
    const bool camera = h->list[h->chosen].thing == ROIL_CAMERA;
    if ((c->dx != 0 || c->dy != 0) && !c->pressed) find_goal(h, l, camera ? &h->held : &view, c);
    if (!structural || !c->held) put(l);
    if (!c->held) h->dragging = false;
    return true;
}

// ---- drawing ------------------------------------------------------------------------------------

static void draw_line(const lens *view, const float a[3], const float b[3], uint32_t color,
                      float width) {
    float at[4], s = ui_scale();
    if (!lens_project_line(view, a, b, at)) return;
    ui_line(at[0], at[1], at[2], at[3], DARK, (width + 2) * s);
    ui_line(at[0], at[1], at[2], at[3], color, width * s);
}

static void draw_box(const lens *view, const float low[3], const float high[3],
                     const float shift[3], uint32_t color) {
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 4; side++) {
            vec3 a, b;
            glm_vec3_add((float *)(uintptr_t)low, (float *)(uintptr_t)shift, a);
            int one = (axis + 1) % 3, other = (axis + 2) % 3;
            if (side & 1) a[one] = high[one] + shift[one];
            if (side & 2) a[other] = high[other] + shift[other];
            glm_vec3_copy(a, b);
            b[axis] = high[axis] + shift[axis];
            draw_line(view, a, b, color, 1);
        }
}

static void draw_path(const live *l, const lens *view, size_t index, uint32_t color) {
    double times[PATH_POINTS], fps = l->time.fps > 0 ? l->time.fps : 24;
    float path[PATH_POINTS][3];
    for (int i = 0; i < PATH_POINTS; i++)
        times[i] = (l->time.last - l->time.first) / fps * i / (PATH_POINTS - 1);
    if (!roil_handle_path(l->effect, index, times, path, PATH_POINTS)) return;
    for (int i = 0; i + 1 < PATH_POINTS; i++) draw_line(view, path[i], path[i + 1], color, 1.4f);
}

static const char *name_of(const roil_handle *one, char out[128]) {
    if (one->key != SIZE_MAX)
        snprintf(out, 128, "%s.key %zu", one->control, one->key + 1);
    else
        snprintf(out, 128, "%s.%s", one->name, one->part);
    return out;
}

static void draw_point(const lens *view, const roil_handle *one, bool chosen, bool hovered) {
    float at[2], s = ui_scale(), r = (DOT + (hovered || chosen ? 1.5f : 0)) * s;
    if (!lens_project(view, one->at, at)) return;
    uint32_t color = chosen ? ui_rgba(UI_ACCENT, 1) : colors[one->thing];
    float x = at[0], y = at[1];
    if (one->along || one->key != SIZE_MAX) {
        ui_fill((ui_rect){x - r - s, y - r - s, x + r + s, y + r + s}, DARK, s);
        ui_fill((ui_rect){x - r + s, y - r + s, x + r - s, y + r - s}, color, s);
    } else if (one->control) {
        ui_disc(x, y, r + 1.5f * s, DARK);
        ui_disc(x, y, r, color);
        if (one->thing == ROIL_SUN) ui_ring(x, y, r + 4 * s, color, 1.5f * s);
    } else {
        ui_ring(x, y, r, DARK, 4 * s);
        ui_ring(x, y, r, color, 1.5f * s);
    }
    char name[128], mark[160];
    snprintf(mark, sizeof mark, "handle %s", name_of(one, name));
    ui_mark(mark, (ui_rect){x - r, y - r, x + r, y + r});
}

static void draw_body(const live *l, const lens *view, size_t i, const float shift[3]) {
    const handles *h = l->handles;
    const roil_handle *one = &h->list[i];
    bool near = (int)i == h->hovered || (int)i == h->chosen;
    uint32_t color = (colors[one->thing] & 0xffffff) | 0xa0000000;
    float at[2];
    bool has_box = memcmp(one->low, one->high, sizeof one->low) != 0;
    if (has_box && (near || one->thing != ROIL_MESH))
        draw_box(view, one->low, one->high, shift, color);
    if (one->radius > 0 && !one->along && lens_project(view, one->at, at)) {
        float r = one->radius * lens_pixels(view, one->at);
        if (r > 2 && r < 1e5f) {
            ui_ring(at[0], at[1], r, DARK, 3 * ui_scale());
            ui_ring(at[0], at[1], r, color, ui_scale());
        }
    }
    bool keyed = i + 1 < h->count && h->list[i + 1].key != SIZE_MAX; // others cost the script time
    if (one->moves && (near || keyed)) draw_path(l, view, i, color);
    if (one->thing == ROIL_SUN) draw_line(view, h->middle, one->at, color, 1);
    if (i > 0 && strcmp(one->part, "target") == 0) {
        for (size_t k = i; k-- > 0;) {
            if (strcmp(h->list[k].part, "position") != 0) continue;
            draw_line(view, h->list[k].at, one->at, color, 1);
            break;
        }
    }
}

static void draw_arrows(const handles *h, const lens *view, const roil_handle *one) {
    static const char *const names[] = {"x", "y", "z"};
    float s = ui_scale(), line[4];
    for (int axis = 0; axis < 3; axis++) {
        if (!arrow_of(view, one, axis, line)) continue;
        bool on = axis == h->hovered_axis || (h->dragging && axis == h->axis);
        float dx = line[2] - line[0], dy = line[3] - line[1], length = hypotf(dx, dy);
        if (length < 12 * s) continue; // seen from its end
        ui_line(line[0], line[1], line[2], line[3], DARK, (on ? 6 : 4) * s);
        ui_line(line[0], line[1], line[2], line[3], axis_colors[axis], (on ? 4 : 2) * s);
        float ux = dx / length * 9 * s, uy = dy / length * 9 * s;
        ui_triangle(line[2] + ux, line[3] + uy, line[2] - uy / 2, line[3] + ux / 2,
                    line[2] + uy / 2, line[3] - ux / 2, axis_colors[axis]);
        char mark[16];
        snprintf(mark, sizeof mark, "handle/%s", names[axis]);
        float x = (line[0] + 3 * line[2]) / 4, y = (line[1] + 3 * line[3]) / 4;
        ui_mark(mark, (ui_rect){x - 3 * s, y - 3 * s, x + 3 * s, y + 3 * s});
    }
}

static void draw_label(const live *l, const lens *view, const roil_handle *one, const float at[3]) {
    char name[128], text[256];
    float p[2], s = ui_scale();
    if (!lens_project(view, at, p)) return;
    if (one->thing == ROIL_SUN || one->along)
        snprintf(text, sizeof text, "%s", name_of(one, name));
    else
        snprintf(text, sizeof text, "%s  %.3g, %.3g, %.3g m", name_of(one, name), (double)at[0],
                 (double)at[1], (double)at[2]);
    if (!one->control) strncat(text, ", moved by the script", sizeof text - strlen(text) - 1);
    float width = ui_text_width(text) + 12 * s, height = label_height() + 4 * s;
    float left = clampf(p[0] + 14 * s, l->view.left, fmaxf(l->view.right - width, l->view.left));
    float top = clampf(p[1] + 10 * s, l->view.top, fmaxf(l->view.bottom - height, l->view.top));
    ui_fill((ui_rect){left, top, left + width, top + height}, ui_rgba(UI_PANEL, 0.88f), 4 * s);
    ui_label(left + 6 * s, top + 2 * s, ui_rgba(UI_TEXT, 1), text);
}

void handles_draw(const live *l) {
    static const float nowhere[3] = {0};
    const handles *h = l->handles;
    lens view;
    if (!view_lens(l, &view)) return;
    if (l->session.ground) ground_draw(l, &view);
    if (!l->session.handles) return;
    for (size_t i = 0; i < h->count; i++) {
        vec3 shift = {0, 0, 0};
        if (!is_seen(h, i)) continue;
        bool held = h->dragging && (int)i == h->chosen && h->list[i].structural;
        if (held) glm_vec3_sub((float *)(uintptr_t)h->to, (float *)(uintptr_t)h->from, shift);
        draw_body(l, &view, i, held ? shift : nowhere);
    }
    for (size_t i = 0; i < h->count; i++)
        if (is_seen(h, i))
            draw_point(&view, &h->list[i], (int)i == h->chosen, (int)i == h->hovered);
    if (h->chosen != NONE && has_arrows(&h->list[h->chosen]))
        draw_arrows(h, &view, &h->list[h->chosen]);
    int told = h->dragging || h->hovered == NONE ? h->chosen : h->hovered;
    if (told != NONE) draw_label(l, &view, &h->list[told], h->dragging ? h->to : h->list[told].at);
}
