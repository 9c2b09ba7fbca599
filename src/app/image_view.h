// Pan, zoom and fit of an image in the inspector's view. Needs no window.
#pragma once
#include "roil.h"

typedef struct image_view {
    float center[2]; // centre of the view in the image, 0 to 1
    float zoom;      // pixels of the view per texel of the shown mip level
    bool fit;        // show the whole image, whatever the size of the view
} image_view;

// Returns the size in texels of the shown plane: a mip level, of a volume along an axis (0 x, 1 y,
// 2 z).
void image_view_plane(const roil_image_info *image, uint32_t mip, int axis, float size[2]);
// Returns the slices of that level along the axis; 1 unless it is a volume.
uint32_t image_view_slices(const roil_image_info *image, uint32_t mip, int axis);

// Fits the image if `fit` is set. `view` is the view's size in pixels, `image` the image's in
// texels.
void image_view_fit(image_view *v, const float view[2], const float image[2]);
void image_view_pan(image_view *v, float dx, float dy, const float image[2]); // pixels
// Zooms around (x, y), pixels from the centre of the view.
void image_view_zoom(image_view *v, float factor, float x, float y, const float image[2]);
void image_view_level(image_view *v, int change); // keeps the view when the mip level changes

// Returns the number of channels of a format by its name: 4 for "rgba16f".
int image_channels(const char *format);
