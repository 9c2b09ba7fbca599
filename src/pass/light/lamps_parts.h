// The inside of the lists of lamps (pass/light/lamps.h), for their own files only.
#pragma once
#include "pass/light/lamps.h"
#include "pass/pass_impl.h"

typedef enum lamps_kernel { LAMPS_RECORDS, LAMPS_MASKS, LAMPS_DRAW, LAMPS_KERNELS } lamps_kernel;
typedef enum lists_buffer { LAMP_RECORDS, LAMP_MASKS, LAMP_BOUNDS, LAMP_BUFFERS } lists_buffer;

#define LAMPS_NAMES(NAME)                                                                          \
    NAME(width), NAME(height), NAME(lamp_count), NAME(lamp_words), NAME(lamp_tiles_across),        \
        NAME(lamp_picture)
enum { LAMPS_NAMES(KERNEL_NAME_ID) };

struct pass_lamps {
    uint32_t count;
    lamps_way way;
    gpu_buffer *buffers[LAMP_BUFFERS];
    gpu_image *light; // what spheres around the lamps have added up, where the way is LAMPS_VOLUMES
};

// lamps_volumes.c: where the way is LAMPS_VOLUMES
void lamps_target(const pass *p, size_t index, gpu_graphics_desc *out);
bool lamps_draw_volumes(pass *p, uint32_t width, uint32_t height); // after the records are made
void lamps_list_light(const pass *p, uint32_t width, uint32_t height, budget_list *out);
