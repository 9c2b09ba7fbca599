// What roil_show and roil_inspect draw with. For src/roil*.c only.
#pragma once
#include "roil_impl.h"

enum { VIEW_MAX_SLOTS = 8, VIEW_READS = GPU_FRAMES_IN_FLIGHT + 1 };

typedef struct view_shader { // a pipeline of shaders/view/, made when it is first used
    gpu_pipeline *pipeline;
    const char *names[VIEW_MAX_SLOTS]; // of its slots
    uint32_t bindings[VIEW_MAX_SLOTS];
    size_t slot_count;
} view_shader;

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
    view_shader compose, overlay, slices;
    view_shader inspect[2][2]; // of volumes, of whole numbers
    view_probe probe;
};

struct roil_texture {
    gpu_image *image;
};

view *view_get(roil *r); // makes it; NULL with a message
// `defines` may be NULL. Once made, these cost nothing.
bool view_make_compute(roil *r, view_shader *s, const char *file, const shader_define *defines,
                       size_t define_count);
// File names without ".vert" and ".frag"; draws over an RGBA8 target.
bool view_make_overlay(roil *r, view_shader *s, const char *file);

typedef struct view_value { // what a slot of that name is bound to
    const char *name;
    gpu_binding binding;
} view_value;
// All slots of the shader, which must be among `values`. Returns their count.
size_t view_bind(const view_shader *s, const view_value *values, size_t count,
                 gpu_binding out[VIEW_MAX_SLOTS]);
