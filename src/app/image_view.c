// Pan, zoom and fit.
#include "app/image_view.h"
#include <math.h>
#include <string.h>

static const float MIN_ZOOM = 1.0f / 64, MAX_ZOOM = 128;

static float clamped(float value, float low, float high) {
    return fminf(fmaxf(value, low), high);
}

static uint32_t level_size(uint32_t size, uint32_t mip) {
    uint32_t level = size >> mip;
    return level ? level : 1;
}

void image_view_plane(const roil_image_info *image, uint32_t mip, int axis, float size[2]) {
    int across = image->volume && axis == 0 ? 1 : 0, down = image->volume && axis != 2 ? 2 : 1;
    size[0] = (float)level_size(image->size[across], mip);
    size[1] = (float)level_size(image->size[down], mip);
}

uint32_t image_view_slices(const roil_image_info *image, uint32_t mip, int axis) {
    return image->volume ? level_size(image->size[axis], mip) : 1;
}

void image_view_fit(image_view *v, const float view[2], const float image[2]) {
    if (!v->fit) return;
    v->center[0] = v->center[1] = 0.5f;
    v->zoom = clamped(fminf(view[0] / image[0], view[1] / image[1]), MIN_ZOOM, MAX_ZOOM);
}

void image_view_pan(image_view *v, float dx, float dy, const float image[2]) {
    const float way[2] = {dx, dy};
    for (int i = 0; i < 2; i++)
        v->center[i] = clamped(v->center[i] - way[i] / (v->zoom * image[i]), 0, 1);
    v->fit = false;
}

void image_view_zoom(image_view *v, float factor, float x, float y, const float image[2]) {
    float zoom = clamped(v->zoom * factor, MIN_ZOOM, MAX_ZOOM);
    float kept = 1 / v->zoom - 1 / zoom; // texels for a pixel that the pointer's place moves by
    v->zoom = zoom;
    v->center[0] = clamped(v->center[0] + x * kept / image[0], 0, 1);
    v->center[1] = clamped(v->center[1] + y * kept / image[1], 0, 1);
    v->fit = false;
}

void image_view_level(image_view *v, int change) {
    v->zoom = clamped(ldexpf(v->zoom, change), MIN_ZOOM, MAX_ZOOM);
}

int image_channels(const char *format) {
    size_t letters = strcspn(format, "0123456789");
    return letters < 1 ? 1 : letters > 4 ? 4 : (int)letters;
}
