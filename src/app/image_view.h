// How an image lies in the view of the inspector: panned, zoomed, fitted. Knows no window.
#pragma once
#include "roil.h"

typedef struct image_view {
    float center[2]; // of the view in the image, 0 to 1
    float zoom;      // pixels of the view for a texel of the level that is seen
    bool fit;        // the whole image, however large the view
} image_view;

// Texels across and down of what is seen: a level, of a volume along an axis (0 x, 1 y, 2 z).
void image_view_plane(const roil_image_info *image, uint32_t mip, int axis, float size[2]);
// Slices of that level along the axis; 1 of what is no volume.
uint32_t image_view_slices(const roil_image_info *image, uint32_t mip, int axis);

// `view` is its size in pixels, `image` its own in texels. Does nothing unless `fit`.
void image_view_fit(image_view *v, const float view[2], const float image[2]);
void image_view_pan(image_view *v, float dx, float dy, const float image[2]); // pixels
// What lies under (x, y), pixels from the centre of the view, stays there.
void image_view_zoom(image_view *v, float factor, float x, float y, const float image[2]);
void image_view_level(image_view *v, int change); // the same part of the image, of another level

// Channels of a format by its name: "rgba16f" has 4.
int image_channels(const char *format);
