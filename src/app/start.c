#include "app/start.h"
#include "app/label.h"
#include "app/live.h"
#include "app/recent.h"
#include "app/starts.h"
#include "app/window.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const float SIDE = 340, PICTURE_WIDE = 176, PICTURE_HIGH = 99, ROW = 22, GAP = 12; // units
enum { TEXELS_WIDE = 352, TEXELS_HIGH = 198, MOST = 256, AWAKE = 4 };
static const double LONG = 600;

typedef struct card {
    const char *section;
    char file[PATH_CAP], name[96];
    bool seen, looked;     // the latter: for a picture
    roil_texture *picture; // NULL: there is none
} card;

typedef struct page {
    roil *r;
    char home[PATH_CAP];
    card *cards;
    size_t count, capacity;
    char path[PATH_CAP], name[64], message[1024];
    bool quit, enter;
    live_session session;
    opening *out;
} page;

// ---- effects ------------------------------------------------------------------------------------

static void add_card(page *p, const char *section, const char *file) {
    if (p->count >= MOST) return;
    for (size_t i = 0; i < p->count; i++)
        if (strcmp(p->cards[i].file, file) == 0 && strcmp(p->cards[i].section, section) == 0)
            return;
    card *c = MEM_ADD(p->cards, p->count, p->capacity);
    *c = (card){.section = section};
    int length;
    const char *name = path_stem(file, &length);
    str_copy(c->file, sizeof c->file, file);
    snprintf(c->name, sizeof c->name, "%.*s", length, name);
}

static void add_files(page *p, const char *section, const char *folder, const char *names) {
    char pattern[PATH_CAP];
    file_list all;
    if (!path_join(pattern, folder, names) || !file_glob(pattern, &all)) return;
    for (size_t i = 0; i < all.count; i++) {
        const char *file = all.paths[i]; // "./a.lua" is said as "a.lua"
        if (str_ends_with(file, ".roil") || app_declares_effect(file))
            add_card(p, section, strncmp(file, "./", 2) == 0 ? file + 2 : file);
    }
    file_list_free(&all);
}

static void list_effects(page *p) {
    char(*recent)[PATH_CAP] = mem_alloc(RECENT_MOST * sizeof *recent), folder[PATH_CAP];
    size_t count = recent_list(recent);
    for (size_t i = 0; i < count; i++) add_card(p, "Recent", recent[i]);
    mem_free(recent);
    add_files(p, "In this folder", ".", "*.lua");
    add_files(p, "In this folder", ".", "*.roil");
    if (path_join(folder, p->home, "effects")) add_files(p, "Shipped with roil", folder, "*.lua");
}

// Looks for one more picture of those that are seen. False: there is none left.
static bool look_for_picture(page *p) {
    size_t i = 0;
    while (i < p->count && (p->cards[i].looked || !p->cards[i].seen)) i++;
    if (i == p->count) return false;
    card *c = &p->cards[i];
    char file[PATH_CAP];
    c->looked = true;
    if (!recent_picture(c->file, file)) return true;
    uint8_t *texels = mem_alloc((size_t)TEXELS_WIDE * TEXELS_HIGH * 4);
    if (roil_read_thumbnail(file, TEXELS_WIDE, TEXELS_HIGH, texels))
        c->picture = roil_texture_create(p->r, TEXELS_WIDE, TEXELS_HIGH, texels);
    else
        log_write(LOG_DEBUG, "live: %s", roil_error());
    mem_free(texels);
    return true;
}

// ---- choosing -----------------------------------------------------------------------------------

static void take(page *p, bool found) {
    if (!found) {
        str_copy(p->message, sizeof p->message, roil_error());
        log_write(LOG_DEBUG, "live: refused: %s", p->message);
    }
    if (found) log_write(LOG_DEBUG, "live: chose %s", p->out->file);
    p->quit = p->quit || found;
}

static void open_path(page *p, const char *path) {
    if (path[0]) take(p, opening_find(p->home, path, p->out));
}

static void on_drop(void *user, const char *path) {
    open_path(user, path);
}

static void on_key(void *user, int key, int mods, bool again) {
    page *p = user;
    (void)again;
    if (key == GLFW_KEY_ENTER) p->enter = true;
    bool control = mods & GLFW_MOD_CONTROL;
    bool resizes = control && (key == GLFW_KEY_EQUAL || key == GLFW_KEY_MINUS);
    if (key == GLFW_KEY_F2) p->session.contrast = !p->session.contrast;
    if (resizes) session_resize(&p->session, key == GLFW_KEY_EQUAL ? 1 : -1);
    if (key == GLFW_KEY_F2 || resizes) session_save(&p->session);
    if (key == GLFW_KEY_ESCAPE || (key == GLFW_KEY_Q && control)) p->quit = true;
}

// ---- drawing ------------------------------------------------------------------------------------

static void draw_none(ui_rect picture) {
    ui_frame(picture, ui_rgba(UI_LINE, 1), 4 * ui_scale(), ui_scale());
    label_center((picture.left + picture.right) / 2,
                 (picture.top + picture.bottom - label_height()) / 2, ui_rgba(UI_LINE, 1),
                 "no picture yet");
}

static void draw_card(page *p, card *c, ui_rect view) {
    float s = ui_scale();
    ui_canvas at = ui_canvas_begin(c->name, PICTURE_WIDE * s, (PICTURE_HIGH + ROW) * s);
    ui_rect picture = at.area;
    picture.bottom = picture.top + PICTURE_HIGH * s;
    c->seen = c->seen || (picture.top < view.bottom && picture.bottom > view.top);
    ui_fill(picture, ui_rgba(UI_FIELD, 1), 4 * s);
    if (c->picture)
        ui_image(picture, c->picture);
    else
        draw_none(picture);
    if (at.hovered) ui_frame(picture, ui_rgba(UI_ACCENT, 1), 4 * s, 2 * s);
    label_within(picture.left, picture.bottom + 2 * s, PICTURE_WIDE * s,
                 ui_rgba(at.hovered ? UI_TEXT : UI_DIM, 1), c->name);
    ui_canvas_end();
    if (at.hovered) ui_tooltip(c->file);
    if (at.pressed) open_path(p, c->file);
}

static void draw_cards(page *p, ui_rect where) {
    float s = ui_scale(), x = 0;
    const char *last = "";
    ui_panel_begin("effects", where);
    ui_rect space = ui_space();
    for (size_t i = 0; i < p->count; i++) {
        card *c = &p->cards[i];
        x += (PICTURE_WIDE + GAP) * s;
        if (strcmp(c->section, last) != 0) {
            if (i > 0) ui_gap(GAP * s);
            ui_text_color(UI_DIM, "%s", c->section);
            x = PICTURE_WIDE * s;
        } else if (x <= space.right - space.left) {
            ui_same_line();
        } else {
            x = PICTURE_WIDE * s;
        }
        last = c->section;
        ui_push(c->section);
        draw_card(p, c, where);
        ui_pop();
    }
    if (!p->count) ui_text_color(UI_DIM, "There are no effects here yet.");
    ui_panel_end();
}

static void draw_new(page *p) {
    ui_text_color(UI_DIM, "New effect in this folder");
    ui_width(0);
    ui_input("##name", "Name", p->name, sizeof p->name);
    for (size_t i = 0; i < STARTS; i++)
        if (ui_button(starts[i].label))
            take(p,
                 opening_new(p->r, starts[i].name, p->name[0] ? p->name : starts[i].name, p->out));
}

static void draw_side(page *p, ui_rect where) {
    float s = ui_scale();
    ui_panel_begin("side", where);
    ui_text_color(UI_DIM, "Open");
    ui_width(-70 * s);
    ui_input("##path", "Path of a file", p->path, sizeof p->path);
    ui_same_line();
    if (ui_button("Open") || (p->enter && p->path[0])) open_path(p, p->path);
    p->enter = false;
    ui_text_wrapped(
        "Or drop a file here: an effect, a PNG picture that roil made, or a VDB file, for "
        "whose sequence an effect is written.");
    ui_gap(16 * s);
    draw_new(p);
    ui_gap(16 * s);
    ui_text_color(UI_DIM, "F2: high contrast");
    ui_text_color(UI_DIM, "Ctrl+=, Ctrl+-: larger, smaller letters");
    if (p->message[0]) {
        ui_gap(16 * s);
        ui_text_color(UI_ERROR, "That did not work");
        ui_text_wrapped(p->message);
    }
    ui_panel_end();
}

// ---- the window ---------------------------------------------------------------------------------

static bool draw_page(page *p, uint32_t width, uint32_t height) {
    roil_picture picture = {.width = width, .height = height, .background = {0.12f, 0.12f, 0.12f}};
    float side = fminf(SIDE * ui_scale(), (float)width * 0.45f);
    ui_begin();
    draw_cards(p, (ui_rect){0, 0, (float)width - side, (float)height});
    draw_side(p, (ui_rect){(float)width - side, 0, (float)width, (float)height});
    ui_end(&picture);
    return roil_show(p->r, &picture);
}

static bool run_page(page *p, window *w) {
    int awake = AWAKE;
    ui_on_key(on_key, p);
    window_on_drop(w, on_drop, p);
    log_write(LOG_DEBUG, "live: start page");
    while (!p->quit && !window_closing(w)) {
        uint32_t width, height;
        bool busy = look_for_picture(p) || awake > 0 || ui_pending();
        bool woken = window_wait(busy ? 0 : LONG) && !busy;
        awake = woken || ui_pending() ? AWAKE : awake - (awake > 0);
        window_pixels(w, &width, &height);
        if (!width) continue;
        ui_set_scale(window_scale(w) * p->session.scale);
        ui_set_contrast(p->session.contrast);
        if (!draw_page(p, width, height)) return false;
    }
    return true;
}

static int run_device(page *p, window *w, const app_device *device) {
    roil_desc desc = app_device_desc(device);
    desc.window = &w->desc;
    p->r = roil_create(&desc);
    if (!p->r) return app_fail_input();
    str_copy(p->home, sizeof p->home, roil_home(p->r));
    list_effects(p);
    bool done = ui_open(w->handle, p->r, NULL) && run_page(p, w);
    int status = done ? APP_DONE : app_fail_input();
    for (size_t i = 0; i < p->count; i++) roil_texture_destroy(p->r, p->cards[i].picture);
    ui_close();
    mem_free(p->cards);
    return app_close(p->r, status);
}

int start_choose(const app_device *device, int width, int height, opening *out) {
    window w;
    page p = {.out = out};
    *out = (opening){.recipe = NULL};
    session_load(&p.session);
    if (!window_open(&w, &p.session, "roil", width, height))
        return app_fail(APP_BAD_INPUT, "live: %s", roil_error());
    int status = run_device(&p, &w, device);
    window_close(&w);
    return status;
}
