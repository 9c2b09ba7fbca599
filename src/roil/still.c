// What goes from the device of the effects to that of the window: pictures that are kept (stills),
// and textures that views of an effect are drawn into.
//
// Where one device does both, a still is a copy that is made there, and a texture is drawn into
// directly. Between two devices the texels go through memory of the host.
#include "base/error.h"
#include "base/memory.h"
#include "roil/view.h"

// ---- textures ---------------------------------------------------------------------------------

static gpu_image *make_texture(gpu *g, uint32_t width, uint32_t height) {
    return gpu_image_create(g, &(gpu_image_desc){.label = "texture",
                                                 .format = GPU_RGBA8,
                                                 .width = width,
                                                 .height = height,
                                                 .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
}

static roil_texture *create_texture(roil *r, uint32_t width, uint32_t height, const uint8_t *rgba) {
    if (!r->device) return ERR_NULL("no device: there are no textures");
    gpu_image *image = make_texture(r->shown, width, height);
    if (!image) return NULL;
    size_t size = (size_t)width * height * 4;
    uint8_t *none = rgba ? NULL : mem_alloc(size);
    bool done = gpu_image_write(r->shown, image, 0, rgba ? rgba : none, size);
    mem_free(none);
    if (!done) {
        gpu_image_destroy(r->shown, image);
        return NULL;
    }
    roil_texture *t = mem_alloc(sizeof *t);
    t->image = image;
    t->version = ++r->textures;
    return t;
}

roil_texture *roil_texture_create(roil *r, uint32_t width, uint32_t height, const uint8_t *rgba) {
    RETURN_MADE(roil_texture, create_texture(r, width, height, rgba),
                roil_texture_destroy(r, made));
}

void roil_texture_destroy(roil *r, roil_texture *t) {
    if (!t) return;
    gpu_image_destroy(r->shown, t->image);
    gpu_image_destroy(r->device, t->drawn);
    mem_free(t);
}

gpu_image *view_drawn(roil *r, roil_texture *t) {
    t->version = ++r->textures;
    if (!roil_shows_apart(r)) return t->image;
    const gpu_image_desc *size = gpu_image_get_desc(t->image);
    if (!t->drawn) t->drawn = make_texture(r->device, size->width, size->height);
    return t->drawn;
}

bool view_bring(roil *r, roil_texture *t) {
    if (!roil_shows_apart(r)) return true;
    const gpu_image_desc *size = gpu_image_get_desc(t->image);
    size_t bytes = (size_t)size->width * size->height * 4;
    uint8_t *texels = mem_alloc(bytes);
    bool done = gpu_image_read(r->device, t->drawn, texels, bytes) &&
                gpu_image_write(r->shown, t->image, 0, texels, bytes);
    mem_free(texels);
    return done;
}

// ---- stills -----------------------------------------------------------------------------------

gpu_image *view_picture(roil_effect *e) {
    if (!e || !e->frame) return NULL;
    graph_image output = effect_get_picture(e->effect, EFFECT_OUTPUT);
    gpu_image *picture = graph_get_image(effect_graph(e->effect), output);
    return picture && gpu_image_get_desc(picture)->format != GPU_R32U ? picture : NULL;
}

static bool still_make(roil *r, roil_still *s) {
    s->image = gpu_image_create(r->shown, &s->size);
    return s->image != NULL;
}

static bool make_way(roil *r, roil_still *s) {
    if (!roil_shows_apart(r)) return still_make(r, s);
    s->readback = gpu_buffer_create(r->device, &(gpu_buffer_desc){.label = s->size.label,
                                                                  .size = gpu_image_bytes(&s->size),
                                                                  .kind = GPU_BUFFER_READBACK});
    return s->readback != NULL;
}

static bool still_fill(roil *r, roil_still *s, gpu_image *picture) {
    s->frame = gpu_frame_begin(r->device);
    if (!s->frame) return false;
    bool done = s->readback ? gpu_image_copy_to_buffer(r->device, picture, s->readback, 0)
                            : gpu_image_copy(r->device, picture, s->image);
    bool ended = gpu_frame_end(r->device);
    return done && ended;
}

static roil_still *create_still(roil_effect *e) {
    roil *r = e->owner;
    gpu_image *picture = view_picture(e);
    if (!picture) return ERR_NULL("there is no picture yet: render a frame first");
    const gpu_image_desc *size = gpu_image_get_desc(picture);
    roil_still *s = mem_alloc(sizeof *s);
    s->size = (gpu_image_desc){.label = "pictures kept",
                               .format = size->format,
                               .width = size->width,
                               .height = size->height,
                               .use = GPU_USE_SAMPLED};
    if (make_way(r, s) && still_fill(r, s, picture)) return s;
    roil_still_destroy(r, s);
    return NULL;
}

roil_still *roil_still_create(roil_effect *e) {
    RETURN_MADE(roil_still, create_still(e), roil_still_destroy(e->owner, made));
}

// Brings it over once it has been drawn. False also when it has not.
static bool arrive(roil *r, roil_still *s) {
    if (!gpu_frame_done(r->device, s->frame) || gpu_is_lost(r->device) || !still_make(r, s))
        return false;
    size_t bytes = (size_t)gpu_image_bytes(&s->size);
    bool done = gpu_image_write(r->shown, s->image, 0, gpu_buffer_map(s->readback), bytes);
    gpu_buffer_destroy(r->device, s->readback);
    s->readback = NULL;
    return done;
}

bool roil_still_ready(roil *r, roil_still *s) {
    return MEM_CALL(!s->readback || arrive(r, s));
}

bool view_wait(roil *r, roil_still *s) {
    return !s->readback || (gpu_frame_wait(r->device, s->frame) && arrive(r, s));
}

uint64_t roil_still_bytes(const roil_still *s) {
    return gpu_image_bytes(&s->size);
}

roil_still *roil_still_share(roil_still *s) {
    s->shared++;
    return s;
}

void roil_still_destroy(roil *r, roil_still *s) {
    if (!s || s->shared-- > 0) return;
    view *v = r->view;
    if (v && (v->picture == s->image || v->other == s->image)) v->holds = false;
    gpu_image_destroy(r->shown, s->image);
    gpu_buffer_destroy(r->device, s->readback);
    mem_free(s);
}
