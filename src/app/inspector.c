// A window that shows any image of the graph: with exposure, single channels, mip levels, slices,
// and the value under the pointer.
//
// An image can be shown only if the graph keeps it: it then has memory of its own, and is drawn
// even if nothing else uses it. Choosing an image therefore prepares the effect again.
#include "app/image_view.h"
#include "app/label.h"
#include "app/live.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// Units, but for what is said.
static const float WIDTH = 540, HEIGHT = 620, MIN_CANVAS = 80, FOOT = 52, BUTTONS = 48;
static const float MAX_EXPOSURE = 12, ZOOM_STEP = 1.2f; // stops; a factor
enum { MAX_NAME = sizeof((roil_image_info *)NULL)->name };
static const char *const channel_names[] = {"r", "g", "b", "a"};

struct inspector {
    roil_image_info *images; // of the effect, as of this frame
    char (*labels)[MAX_NAME + 16];
    const char **words;
    size_t count, image_capacity, label_capacity, word_capacity;

    char kept[MAX_NAME]; // what the effect was told to keep; "": nothing
    uint64_t reloads;    // when it was
    bool all;            // it was told to keep all images
    char failure[512];   // why nothing is seen; "": it is

    roil_inspection how;
    image_view view;
    bool channels[4];
    roil_texture *texture;
    uint32_t width, height; // of it
    uint32_t wanted[2];     // the same by now; 0: not drawn yet
    bool pointed;           // at the picture
    roil_texel texel;
};

inspector *inspector_create(void) {
    inspector *p = mem_alloc(sizeof *p);
    p->view.fit = true;
    p->view.zoom = 1;
    p->how.axis = 1;
    p->how.slice = 0.5f;
    for (int i = 0; i < 4; i++) p->channels[i] = i < 3;
    return p;
}

void inspector_destroy(inspector *p, roil *r) {
    roil_texture_destroy(r, p->texture);
    mem_free(p->images);
    mem_free(p->labels);
    mem_free(p->words);
    mem_free(p);
}

// ---- which image --------------------------------------------------------------------------------

static void list_images(inspector *p, roil_effect *e) {
    p->count = roil_images(e, NULL, 0);
    MEM_RESERVE(p->images, p->count, p->image_capacity);
    MEM_RESERVE(p->labels, p->count, p->label_capacity);
    MEM_RESERVE(p->words, p->count, p->word_capacity);
    roil_images(e, p->images, p->count);
    for (size_t i = 0; i < p->count; i++) {
        const roil_image_info *image = &p->images[i];
        snprintf(p->labels[i], sizeof p->labels[i], "%s%s", image->name,
                 image->culled ? "  (not drawn)" : "");
        p->words[i] = p->labels[i];
    }
}

static const roil_image_info *find_image(const inspector *p, const char *name) {
    for (size_t i = 0; i < p->count; i++)
        if (strcmp(p->images[i].name, name) == 0) return &p->images[i];
    return NULL;
}

// Returns the image that was chosen, now or in an earlier session; at first the last one that is
// drawn.
static const roil_image_info *find_chosen(const inspector *p, live_session *session) {
    if (session->image[0]) return find_image(p, session->image);
    for (size_t i = p->count; i-- > 0;) {
        if (p->images[i].culled) continue;
        str_copy(session->image, sizeof session->image, p->images[i].name);
        return &p->images[i];
    }
    return NULL;
}

// Limits the mip level and the slice to those of the chosen image.
static void fit_choice(inspector *p, const roil_image_info *image) {
    if (p->how.mip >= image->mips) {
        image_view_level(&p->view, (int)p->how.mip);
        p->how.mip = 0;
    }
}

// ---- keeping it ---------------------------------------------------------------------------------

static bool prepare_again(live *l) {
    return roil_prepare(l->effect, l->width, l->height) &&
           roil_advance(l->effect, l->time.frame); // else there is nothing to be seen
}

// Keeps an image, or all while the graph shows them. False, and a message in `failure`, when the
// effect cannot be drawn with it.
static bool inspector_keep(live *l, const char *image) {
    inspector *p = l->inspector;
    const bool all = l->session.graph;
    uint64_t reloads = roil_live_counts(l->follow).reloads;
    bool reloaded = p->reloads != reloads;
    if (reloaded && !find_image(p, p->kept)) p->kept[0] = '\0'; // else kept on
    bool same = all ? p->all && !reloaded : !p->all && strcmp(p->kept, image) == 0;
    p->reloads = reloads;
    p->all = all;
    str_copy(p->kept, sizeof p->kept, image);
    if (same) return true;
    roil_keep_only(l->effect, image[0] ? image : NULL);
    for (size_t i = 0; all && i < p->count; i++)
        if (!p->images[i].culled) roil_keep(l->effect, p->images[i].name);
    bool done = prepare_again(l);
    if (!done && all) { // there may be no memory for all
        live_notice(l, "%s", roil_error());
        roil_keep_only(l->effect, image[0] ? image : NULL);
        done = prepare_again(l);
    }
    return done || !str_copy(p->failure, sizeof p->failure, roil_error());
}

// Makes the texture as large as its area in the last frame.
static bool resize_texture(inspector *p, roil *r) {
    if (p->texture && p->width == p->wanted[0] && p->height == p->wanted[1]) return true;
    roil_texture_destroy(r, p->texture);
    p->width = p->wanted[0];
    p->height = p->wanted[1];
    p->texture = roil_texture_create(r, p->width, p->height, NULL);
    return p->texture || !str_copy(p->failure, sizeof p->failure, roil_error());
}

void inspector_update(live *l) {
    inspector *p = l->inspector;
    if (!l->effect) return;
    list_images(p, l->effect);
    bool open = l->session.inspector;
    const roil_image_info *image = open ? find_chosen(p, &l->session) : NULL;
    if (!inspector_keep(l, image ? image->name : "") || !image) return;
    if (!p->wanted[0] || !resize_texture(p, l->r)) return;
    p->how.image = p->kept;
    roil_texel texel;
    if (!roil_inspect(l->effect, &p->how, p->texture, &texel)) {
        str_copy(p->failure, sizeof p->failure, roil_error());
        return;
    }
    p->failure[0] = '\0';
    p->texel = texel;
}

// ---- the rows above the picture -----------------------------------------------------------------

static void draw_choice(inspector *p, live_session *session, const roil_image_info *image) {
    size_t index = image ? (size_t)(image - p->images) : p->count;
    ui_width(-ui_text_width("Fit1:1") - BUTTONS * ui_scale());
    if (ui_choice("##image", &index, p->words, p->count)) {
        str_copy(session->image, sizeof session->image, p->images[index].name);
        p->texel.valid = false;
    }
    ui_same_line();
    if (ui_button("Fit")) p->view.fit = true;
    ui_tooltip("The whole image (double click)");
    ui_same_line();
    if (ui_button("1:1")) {
        p->view.zoom = 1;
        p->view.fit = false;
    }
    ui_tooltip("A pixel for each texel");
}

static void draw_channels(inspector *p, const roil_image_info *image) {
    static const char *const words[] = {"R", "G", "B", "A"};
    static const float colors[4][3] = {
        {0.66f, 0.07f, 0.05f}, {0.12f, 0.42f, 0.08f}, {0.07f, 0.22f, 0.8f}, {0.45f, 0.45f, 0.45f}};
    p->how.channels = 0;
    for (int i = 0; i < image_channels(image->format); i++) {
        label_switch(words[i], &p->channels[i], ui_pack(colors[i], 1));
        ui_same_line();
        if (p->channels[i]) p->how.channels |= 1u << i;
    }
    label_switch("sign", &p->how.negative, ui_rgba(UI_ACCENT, 1));
    ui_tooltip("What is above zero orange, what is below blue");
}

static void draw_level(inspector *p, const roil_image_info *image) {
    int mip = (int)p->how.mip;
    ui_disable_begin(image->mips < 2);
    if (ui_whole("level", &mip, 0, (int)image->mips - 1, "")) {
        image_view_level(&p->view, mip - (int)p->how.mip);
        p->how.mip = (uint32_t)mip;
    }
    ui_disable_end();
}

static void draw_slice(inspector *p, const roil_image_info *image) {
    static const char *const axes[] = {"x", "y", "z"};
    float half = (ui_space().right - ui_space().left) / 2 - 4 * ui_scale();
    size_t axis = (size_t)p->how.axis;
    ui_width(half);
    if (ui_choice("along", &axis, axes, 3)) p->how.axis = (int)axis;
    int slices = (int)image_view_slices(image, p->how.mip, p->how.axis);
    int slice = (int)fminf(floorf(p->how.slice * (float)slices), (float)(slices - 1));
    ui_same_line();
    ui_disable_begin(slices < 2);
    if (ui_whole("slice", &slice, 0, slices - 1, ""))
        p->how.slice = ((float)slice + 0.5f) / (float)slices;
    ui_disable_end();
}

static void draw_rows(inspector *p, const roil_image_info *image) {
    float half = (ui_space().right - ui_space().left) / 2 - 4 * ui_scale();
    draw_channels(p, image);
    ui_width(half);
    ui_number("exposure", &p->how.exposure, 1, -MAX_EXPOSURE, MAX_EXPOSURE, false, "EV");
    ui_same_line();
    draw_level(p, image);
    if (image->volume) draw_slice(p, image);
}

// ---- the picture --------------------------------------------------------------------------------

static void inspector_move(inspector *p, const roil_image_info *image, const ui_canvas *c) {
    float plane[2];
    const float size[2] = {(float)p->wanted[0], (float)p->wanted[1]};
    image_view_plane(image, p->how.mip, p->how.axis, plane);
    float x = c->x - c->area.left, y = c->y - c->area.top;
    if (c->double_clicked) p->view.fit = true;
    image_view_fit(&p->view, size, plane);
    if ((c->held || c->middle_held) && (c->dx != 0 || c->dy != 0))
        image_view_pan(&p->view, c->dx, c->dy, plane);
    if (c->wheel != 0)
        image_view_zoom(&p->view, powf(ZOOM_STEP, c->wheel), x - size[0] / 2, y - size[1] / 2,
                        plane);
    p->pointed = c->hovered;
    p->how.zoom = p->view.zoom;
    memcpy(p->how.center, p->view.center, sizeof p->how.center);
    p->how.cursor[0] = c->hovered ? floorf(x) : -1;
    p->how.cursor[1] = c->hovered ? floorf(y) : -1;
}

static void draw_text_in(const ui_canvas *c, ui_color color, const char *text) {
    float y = (c->area.top + c->area.bottom - ui_line_height()) / 2;
    float width = c->area.right - c->area.left - 24 * ui_scale();
    float left = c->area.left + 12 * ui_scale() + fmaxf(width - ui_text_width(text), 0) / 2;
    label_within(left, y, width, ui_rgba(color, 1), text);
}

static void draw_picture(inspector *p, const roil_image_info *image) {
    ui_rect space = ui_space();
    float height = fmaxf(space.bottom - space.top - FOOT * ui_scale(), MIN_CANVAS * ui_scale());
    ui_canvas c = ui_canvas_begin("inspected", 0, floorf(height));
    p->wanted[0] = (uint32_t)fmaxf(c.area.right - c.area.left, 1);
    p->wanted[1] = (uint32_t)fmaxf(c.area.bottom - c.area.top, 1);
    ui_fill(c.area, ui_rgba(UI_FIELD, 1), 0);
    if (image) {
        inspector_move(p, image, &c);
        if (p->texture) ui_image(c.area, p->texture);
    }
    if (p->failure[0]) draw_text_in(&c, UI_ERROR, p->failure);
    ui_canvas_end();
}

// ---- the lines below it -------------------------------------------------------------------------

static void texel_text(const inspector *p, const roil_image_info *image, char *out,
                       size_t capacity) {
    const uint32_t *at = p->texel.at;
    int used = image->volume ? snprintf(out, capacity, "(%u, %u, %u)", at[0], at[1], at[2])
                             : snprintf(out, capacity, "(%u, %u)", at[0], at[1]);
    for (int i = 0; i < image_channels(image->format) && used > 0 && (size_t)used < capacity; i++)
        used += snprintf(out + used, capacity - (size_t)used, "   %s %.5g", channel_names[i],
                         (double)p->texel.value[i]);
}

static void draw_foot(const inspector *p, const roil_image_info *image) {
    char text[160];
    if (p->pointed && p->texel.valid) {
        texel_text(p, image, text, sizeof text);
        ui_text("%s", text);
    } else {
        ui_text_color(UI_DIM, "Point at the image to read a value");
    }
    const uint32_t *size = image->size;
    int used = snprintf(text, sizeof text, "%u \u00d7 %u", size[0], size[1]);
    if (image->volume)
        used += snprintf(text + used, sizeof text - (size_t)used, " \u00d7 %u", size[2]);
    float plane[2];
    image_view_plane(image, p->how.mip, p->how.axis, plane);
    if (p->how.mip)
        snprintf(text + used, sizeof text - (size_t)used, ", of this level %.0f \u00d7 %.0f",
                 (double)plane[0], (double)plane[1]);
    ui_text_color(UI_DIM, "%s   %s   %.0f %%", image->format, text, 100 * (double)p->view.zoom);
}

void inspector_draw(live *l) {
    if (!l->session.inspector) return;
    inspector *p = l->inspector;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, true);
    if (ui_window_begin("Inspector", &l->session.inspector, where, false)) {
        p->count = 0;
        if (l->effect) list_images(p, l->effect);
        const roil_image_info *image = find_chosen(p, &l->session);
        draw_choice(p, &l->session, image);
        image = find_chosen(p, &l->session); // it may be another now
        if (image) {
            fit_choice(p, image);
            draw_rows(p, image);
        } else if (l->effect) {
            snprintf(p->failure, sizeof p->failure, "The effect has no image '%s' any more",
                     l->session.image);
        }
        draw_picture(p, image);
        if (image) draw_foot(p, image);
    }
    ui_window_end();
}
