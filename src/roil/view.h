// Kernels and images that roil_show and roil_inspect draw with. For src/roil*.c only.
// The window may be drawn by another device than the effects (struct roil).
#pragma once
#include "kernel/kernel.h"
#include "roil/redraw.h"
#include "roil/roil_impl.h"

enum { VIEW_READS = GPU_FRAMES_IN_FLIGHT + 1 };

#define VIEW_NAMES(NAME)                                                                           \
    NAME(View), NAME(srgb), NAME(noise), NAME(picture), NAME(other), NAME(canvas), NAME(Vertices), \
        NAME(Indices), NAME(image), NAME(texel)
enum { VIEW_NAMES(KERNEL_NAME_ID) };
extern const kernel_table view_kernel_table;

typedef struct view_probe {      // reads values under the cursor back to the host
    gpu_image *texel;            // the shader writes the value and its position here
    gpu_buffer *readback;        // VIEW_READS of them
    uint64_t frames[VIEW_READS]; // GPU frame that wrote each; 0: nothing was written
    uint32_t next;
    const roil_effect *effect; // the effect that `image` belongs to
    graph_image image;
} view_probe;

struct roil_texture {
    gpu_image *image;
    gpu_image *drawn; // what the effects' device draws for it; `image` where it draws the window
    uint64_t version; // another one for each content, and for each texture
};

struct roil_still {
    gpu_image *image;     // of the window's device; NULL: it has not arrived
    gpu_buffer *readback; // of the effects' device, on the way from there; NULL: it is not
    uint64_t frame;       // of the effects' device, that fills it
    gpu_image_desc size;  // of the image
    unsigned shared;      // how often, beside its maker
};

typedef struct compose_block { // std140, as compose.comp has it
    float background[4];
    int32_t place[4], beside[4];
    int32_t split[4]; // in the first
} compose_block;

struct view {
    arena memory;
    shader_library *library;
    gpu_image *srgb;                      // of the effects' device; all below is the window's
    gpu_image *srgb_fine, *noise, *white; //
    gpu_image *canvas;                    // the picture shown last
    gpu_image *below;                     // what lies below the interface in it, ...
    compose_block composed;               // ... made of this ...
    const gpu_image *picture, *other;     // ... and of these; NULL: of none
    bool holds;                           // these have not changed since
    redraw_below made;                    // counts how often it was made
    redraw redraw;                        // what the canvas shows
    roil_still *own;                      // of the effect that roil_show was given
    gpu_buffer *vertices, *indices;
    kernel compose, overlay; // each is built when it is first used
    kernel slices;           // of the effects' device, as are those below
    kernel inspect[2][2];    // [of volumes][of integers]
    view_probe probe;
};

// The image that kernels of the effects' device draw a texture into, and its way to the window once
// they have drawn. NULL and false with a message.
gpu_image *view_drawn(roil *r, roil_texture *t);
bool view_bring(roil *r, roil_texture *t);
// The picture of the effect. NULL when none was rendered, or when its texels are integers.
gpu_image *view_picture(roil_effect *e);
bool view_wait(roil *r, roil_still *s); // until it is there

view *view_get(roil *r); // creates it on the first call; NULL with a message
// Build a kernel of a device on the first call and return at once on later ones. `defines` may be
// NULL.
bool view_make_compute(roil *r, gpu *device, kernel *k, const char *file,
                       const shader_define *defines, size_t define_count);
bool view_make_overlay(roil *r, kernel *k); // it draws over an RGBA8 target
