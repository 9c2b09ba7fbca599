// What roil_show and roil_inspect draw with. For src/roil*.c only.
#pragma once
#include "kernel/kernel.h"
#include "roil_impl.h"

enum { VIEW_READS = GPU_FRAMES_IN_FLIGHT + 1 };

#define VIEW_NAMES(NAME)                                                                           \
    NAME(View), NAME(srgb), NAME(noise), NAME(picture), NAME(canvas), NAME(Vertices),              \
        NAME(Indices), NAME(image), NAME(texel)
enum { VIEW_NAMES(KERNEL_NAME_ID) };
extern const kernel_table view_kernel_table;

typedef struct view_probe {      // values under the cursor on their way back to the host
    gpu_image *texel;            // the shader writes the value, and where it is
    gpu_buffer *readback;        // VIEW_READS of them
    uint64_t frames[VIEW_READS]; // of the GPU; 0: nothing was written
    uint32_t next;
    const roil_effect *effect; // whose image it is
    graph_image image;
} view_probe;

struct view {
    arena memory;
    shader_library *library;
    gpu_image *srgb, *srgb_fine, *noise, *white;
    gpu_image *canvas; // what was shown last
    gpu_buffer *vertices, *indices;
    kernel compose, overlay, slices; // each is built when it is first used
    kernel inspect[2][2];            // of volumes, of whole numbers
    view_probe probe;
};

struct roil_texture {
    gpu_image *image;
};

view *view_get(roil *r); // makes it; NULL with a message
// `defines` may be NULL. Once made, these cost nothing.
bool view_make_compute(roil *r, kernel *k, const char *file, const shader_define *defines,
                       size_t define_count);
bool view_make_overlay(roil *r, kernel *k); // draws over an RGBA8 target
