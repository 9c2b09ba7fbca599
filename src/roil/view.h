// Kernels and images that roil_show and roil_inspect draw with. For src/roil*.c only.
#pragma once
#include "kernel/kernel.h"
#include "roil/roil_impl.h"

enum { VIEW_READS = GPU_FRAMES_IN_FLIGHT + 1 };

#define VIEW_NAMES(NAME)                                                                           \
    NAME(View), NAME(srgb), NAME(noise), NAME(picture), NAME(canvas), NAME(Vertices),              \
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

struct view {
    arena memory;
    shader_library *library;
    gpu_image *srgb, *srgb_fine, *noise, *white;
    gpu_image *canvas; // the picture shown last
    gpu_buffer *vertices, *indices;
    kernel compose, overlay, slices; // each is built when it is first used
    kernel inspect[2][2];            // [of volumes][of integers]
    view_probe probe;
};

struct roil_texture {
    gpu_image *image;
};

view *view_get(roil *r); // creates it on the first call; NULL with a message
// Build a kernel on the first call and return at once on later ones. `defines` may be NULL.
bool view_make_compute(roil *r, kernel *k, const char *file, const shader_define *defines,
                       size_t define_count);
bool view_make_overlay(roil *r, kernel *k); // it draws over an RGBA8 target
