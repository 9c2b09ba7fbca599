// A host's Vulkan device, images and semaphores, handed to the layer gpu as numbers and pointers.
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include "roil_vulkan.h"
#include <string.h>
#include <unistd.h>

static gpu_host host_of(const roil_vulkan *v) {
    return (gpu_host){.get_proc = (void (*(*)(void *, const char *))(void))v->get,
                      .instance = v->instance,
                      .physical = v->physical,
                      .device = v->device,
                      .family = v->family,
                      .index = v->index,
                      .features = v->features,
                      .extensions = v->extensions,
                      .extension_count = v->extension_count,
                      .labels = v->labels,
                      .lock = v->lock,
                      .unlock = v->unlock,
                      .user = v->user};
}

static bool find_needs(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                       VkPhysicalDevice physical, roil_vulkan_needs *out) {
    const gpu_host host =
        host_of(&(roil_vulkan){.get = get, .instance = instance, .physical = physical});
    gpu_host_needs needs;
    *out = (roil_vulkan_needs){0};
    if (!gpu_host_find_needs(&host, &out->features, &out->v11, &out->v12, &out->v13, &needs))
        return false;
    out->extension_count = needs.extension_count;
    for (uint32_t i = 0; i < needs.extension_count; i++) out->extensions[i] = needs.extensions[i];
    return true;
}

bool roil_vulkan_find_needs(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                            VkPhysicalDevice physical, roil_vulkan_needs *out) {
    return MEM_CALL(find_needs(get, instance, physical, out));
}

gpu *roil_open_host(const gpu_desc *how, const roil_vulkan *vulkan) {
    const gpu_host host = host_of(vulkan);
    gpu_desc with = *how;
    with.host = &host;
    return gpu_create(&with);
}

// ---- frames -----------------------------------------------------------------------------------

typedef struct handover { // what is at work in a frame
    roil_effect *effect;
    const roil_vulkan_frame *frame;
    gpu_image *depth; // borrowed; NULL: none
    bool returned;    // the images are
} handover;

static const char *const labels[ROIL_LAYER_IMAGES] = {
    [ROIL_LAYER_COLOR] = "image for the colour",
    [ROIL_LAYER_TRANSMITTANCE] = "image for the transmittance",
    [ROIL_LAYER_DEPTH] = "image for the depth",
    [ROIL_LAYER_MOTION] = "image for the motion",
};

static gpu_host_image image_of(const roil_vulkan_image *image, const char *label) {
    return (gpu_host_image){.image = (uint64_t)(uintptr_t)image->image,
                            .format = (int)image->format,
                            .width = image->width,
                            .height = image->height,
                            .before = (int)image->before,
                            .after = (int)image->after,
                            .external = image->external,
                            .label = label};
}

static gpu_host_image depth_of(const roil_vulkan_frame *f) {
    return image_of(&f->depth, "depth buffer");
}

static bool ask(const roil_effect *e, const roil_vulkan_frame *f) {
    gpu_semaphore waits[ROIL_VULKAN_SEMAPHORES], signals[ROIL_VULKAN_SEMAPHORES];
    for (uint32_t i = 0; i < f->wait_count; i++)
        waits[i] = (gpu_semaphore){(uint64_t)(uintptr_t)f->waits[i].semaphore, f->waits[i].value};
    for (uint32_t i = 0; i < f->signal_count; i++)
        signals[i] =
            (gpu_semaphore){(uint64_t)(uintptr_t)f->signals[i].semaphore, f->signals[i].value};
    return gpu_frame_sync(e->owner->device, waits, f->wait_count, signals, f->signal_count);
}

static bool begin(void *user) {
    handover *h = user;
    const gpu_host_image from = depth_of(h->frame);
    if (!ask(h->effect, h->frame)) return false;
    if (!from.image) return true;
    h->depth = gpu_image_borrow(h->effect->owner->device, &from);
    effect_give_depth(h->effect->effect, h->depth);
    return h->depth;
}

// Hands out the images, or only changes their layouts.
static bool end(void *user, bool done) {
    handover *h = user;
    roil_effect *e = h->effect;
    gpu *g = e->owner->device;
    const gpu_host_image from = depth_of(h->frame);
    for (int i = 0; i < ROIL_LAYER_IMAGES; i++) {
        const gpu_host_image to = image_of(&h->frame->images[i], labels[i]);
        gpu_image *image =
            done ? graph_get_image(effect_graph(e->effect), e->layer.images[i]) : NULL;
        if (to.image && !gpu_image_hand_out(g, image, &to)) done = false;
    }
    if (h->depth)
        gpu_image_give_back(g, h->depth, &from);
    else if (from.image)
        gpu_image_hand_out(g, NULL, &from);
    h->returned = true;
    return done;
}

static bool check_image(const roil_vulkan_image *image, const char *label) {
    if (!image->image) return true;
    if (image->width < 1 || image->height < 1)
        return err_set("the host's %s: its size is %u x %u", label, image->width, image->height);
    return (image->after != VK_IMAGE_LAYOUT_UNDEFINED &&
            image->after != VK_IMAGE_LAYOUT_PREINITIALIZED) ||
           err_set("the host's %s: `after` is a layout that no image can be given", label);
}

static bool check_frame(const roil_effect *e, const roil_vulkan_frame *f) {
    if (!e->has_layer) return err_set("the effect is no layer: roil_make_layer makes it one");
    if (!e->width) return err_set("the effect is not prepared: roil_prepare comes first");
    if (f->wait_count > ROIL_VULKAN_SEMAPHORES || f->signal_count > ROIL_VULKAN_SEMAPHORES)
        return err_set("%u semaphores to wait for and %u to signal; accepted: up to %d of each",
                       f->wait_count, f->signal_count, ROIL_VULKAN_SEMAPHORES);
    if (!check_image(&f->depth, "depth buffer")) return false;
    if (f->depth.image && f->depth.before == VK_IMAGE_LAYOUT_UNDEFINED)
        return err_set("the host's depth buffer: in layout UNDEFINED it has no content");
    if (f->depth.image && !effect_has_view(e->effect))
        return err_set("the host's depth buffer: roil_set_view must say how it was projected");
    for (int i = 0; i < ROIL_LAYER_IMAGES; i++) {
        const bool there = graph_get_image(effect_graph(e->effect), e->layer.images[i]);
        if (!check_image(&f->images[i], labels[i])) return false;
        if (f->images[i].image && !there)
            return err_set("the host's %s: roil_layer_desc did not ask for it", labels[i]);
    }
    return true;
}

// A frame that only gives back, where the effect's own did not come to it.
static void give_back(handover *h) {
    char *why = mem_copy(err_get(), strlen(err_get()) + 1);
    if (gpu_frame_begin(h->effect->owner->device)) {
        ask(h->effect, h->frame);
        end(h, false);
        gpu_frame_end(h->effect->owner->device);
    }
    err_set("%s", why);
    mem_free(why);
}

static bool render(roil_effect *e, double frame, const roil_vulkan_frame *f,
                   bool (*draw)(roil_effect *e, double frame)) {
    handover h = {.effect = e, .frame = f};
    if (!check_frame(e, f)) return false;
    mem_enter();
    effect_around_frame(e->effect, begin, end, &h);
    bool done = draw(e, frame);
    effect_around_frame(e->effect, NULL, NULL, NULL);
    if (!h.returned) give_back(&h);
    return mem_leave(done);
}

bool roil_vulkan_render(roil_effect *e, double frame, const roil_vulkan_frame *f) {
    return render(e, frame, f, roil_render);
}

bool roil_vulkan_advance(roil_effect *e, double frame, const roil_vulkan_frame *f) {
    return render(e, frame, f, roil_advance);
}

// ---- for other processes ----------------------------------------------------------------------

static void take_shared(const gpu_shared *from, roil_vulkan_shared *out) {
    *out = (roil_vulkan_shared){.semaphore.semaphore = (VkSemaphore)(uintptr_t)from->semaphore,
                                .fd = from->fd,
                                .size = from->size,
                                .memory_type = from->type,
                                .inside = from->inside};
    memcpy(out->device_uuid, from->device, sizeof out->device_uuid);
    memcpy(out->driver_uuid, from->driver, sizeof out->driver_uuid);
}

// What was made is closed, and gone, when memory was short.
static bool leave_shared(roil *r, bool done, roil_vulkan_shared *out) {
    if (done && mem_is_short()) {
        close(out->fd);
        roil_vulkan_unshare(r, out);
    }
    return mem_leave(done);
}

static bool share_image(roil *r, VkFormat format, uint32_t width, uint32_t height,
                        roil_vulkan_shared *out) {
    gpu_shared shared;
    if (!r->device) return err_set("no device: there is no image to share");
    if (!gpu_share_image(r->device, (int)format, width, height, &shared)) return false;
    take_shared(&shared, out);
    out->image = (roil_vulkan_image){.image = (VkImage)(uintptr_t)shared.image,
                                     .format = format,
                                     .width = width,
                                     .height = height,
                                     .after = VK_IMAGE_LAYOUT_GENERAL,
                                     .external = true};
    return true;
}

bool roil_vulkan_share_image(roil *r, VkFormat format, uint32_t width, uint32_t height,
                             roil_vulkan_shared *out) {
    mem_enter();
    return leave_shared(r, share_image(r, format, width, height, out), out);
}

static bool share_semaphore(roil *r, roil_vulkan_shared *out) {
    gpu_shared shared;
    if (!r->device) return err_set("no device: there is no semaphore to share");
    if (!gpu_share_semaphore(r->device, &shared)) return false;
    take_shared(&shared, out);
    return true;
}

bool roil_vulkan_share_semaphore(roil *r, roil_vulkan_shared *out) {
    mem_enter();
    return leave_shared(r, share_semaphore(r, out), out);
}

void roil_vulkan_unshare(roil *r, roil_vulkan_shared *shared) {
    gpu_shared own = {.image = (uint64_t)(uintptr_t)shared->image.image,
                      .semaphore = (uint64_t)(uintptr_t)shared->semaphore.semaphore,
                      .inside = shared->inside};
    gpu_unshare(r->device, &own);
    *shared = (roil_vulkan_shared){.fd = -1};
}
