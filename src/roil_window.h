// The content of a window: pictures of effects, a user interface over them, and images looked into.
// Part of roil.h, which includes it; its rules on errors, threads and memory hold here too.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

// `rgba` has width * height * 4 bytes, rows from the top. NULL: transparent.
roil_texture *roil_texture_create(roil *r, uint32_t width, uint32_t height, const uint8_t *rgba);
void roil_texture_destroy(roil *r, roil_texture *t); // NULL is allowed

// A picture of an effect, kept to be shown again. It outlives the effect.
typedef struct roil_still roil_still;
// Keeps the picture of the last frame. Returns at once: the device makes it when it has drawn the
// frame. NULL with a message: there is no picture, or no memory for another one.
roil_still *roil_still_create(roil_effect *e);
bool roil_still_ready(roil *r, roil_still *s); // it can be shown; never waits
uint64_t roil_still_bytes(const roil_still *s);
roil_still *roil_still_share(roil_still *s);     // the same one, to be destroyed once more
void roil_still_destroy(roil *r, roil_still *s); // NULL is allowed
// Reads a PNG picture and fits it into a size in pixels, 1 to 16384 each: it is made smaller and
// cut to that aspect ratio. `rgba` must hold width * height * 4 bytes, rows from the top. Any
// thread.
bool roil_read_thumbnail(const char *png, uint32_t width, uint32_t height, uint8_t *rgba);

typedef struct roil_vertex {
    float x, y;     // pixels from the top left
    float u, v;     // texture coordinates, 0 to 1
    uint32_t color; // sRGB with straight alpha, red in the lowest byte; multiplies the texture
} roil_vertex;
typedef struct roil_draw {       // triangles with one texture
    const roil_texture *texture; // NULL: white
    uint32_t first, count;       // range of `indices`
    float clip[4];               // left, top, right, bottom in pixels
} roil_draw;
typedef struct roil_picture { // the content of a window
    uint32_t width, height;   // pixels
    float background[3];      // sRGB, 0 to 1
    roil_effect *effect;      // its last picture is shown; NULL: none
    roil_still *still;        // is shown instead, nothing while it is not ready; NULL: `effect`
    // With a still: another one, which is shown to the right of `split` (pixels). NULL: none is.
    roil_still *beside;
    float split;
    float view[4]; // left, top, right, bottom (pixels) of the area for it; its aspect ratio is kept
    const roil_vertex *vertices;
    const uint32_t *indices;
    const roil_draw *draws; // drawn in order over the effect
    size_t vertex_count, index_count, draw_count;
} roil_picture;
// Draws the picture and presents it when there is a window, which waits for the display. A width or
// height of 0 (a minimised window) shows nothing. Returns false when an index is out of range, and
// when the device is lost.
bool roil_show(roil *r, const roil_picture *picture);
// Reads the picture shown last: `out` must hold its width * height * 4 bytes. Waits for the device.
bool roil_read_shown(roil *r, uint8_t *out);

// A view of an image of the graph. Volumes are shown in slices with z up, or y up when seen along
// z. Pixels outside of the image are dark; infinities and NaN are magenta; a checkerboard shows
// through alpha.
typedef struct roil_inspection {
    const char *image; // it must be kept (roil_keep), unless it shares its memory with no other
    uint32_t mip;      // mip level, from 0
    int axis;          // of a volume: the viewing direction, 0: x, 1: y, 2: z
    float slice;       // of a volume: position along the axis, 0 to 1
    float exposure;    // stops
    unsigned channels; // bits: 1 red, 2 green, 4 blue, 8 alpha; a single channel is shown in grey
    bool negative;     // show the sign of the largest channel: positive orange, negative blue
    float center[2];   // centre of the view in the image or slice, 0 to 1 from the top left
    float zoom;        // pixels of the target per pixel of the image, above 0
    float cursor[2];   // pixel of the target whose value is read; negative: none
} roil_inspection;
typedef struct roil_texel {
    bool valid;     // false: there is no value yet, or the cursor is outside of the image
    uint32_t at[3]; // texel of the mip level
    float value[4]; // as stored; missing channels are 0, and alpha 1
} roil_texel;
typedef struct roil_image_info {
    char name[96];
    const char *format;     // "rgba16f"; static
    uint32_t size[3], mips; // size[2] 1: two-dimensional
    bool volume, culled;    // culled: nothing reads it, so it is not computed
} roil_image_info;
// Lists the images of the graph, after roil_prepare; before it there are 0.
size_t roil_images(roil_effect *e, roil_image_info *out, size_t capacity);
// Draws the view into `target`. `texel` receives the value under the cursor, which is that of an
// earlier call whose frame has finished, so that nothing waits.
bool roil_inspect(roil_effect *e, const roil_inspection *how, roil_texture *target,
                  roil_texel *texel);

#ifdef __cplusplus
}
#endif
