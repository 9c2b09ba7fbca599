// The inside of the lists of point lights (pass/light/point_lights.h), for their own files only.
#pragma once
#include "pass/light/point_lights.h"
#include "pass/pass_impl.h"

typedef enum point_lights_kernel {
    POINT_LIGHTS_RECORDS,
    POINT_LIGHTS_MASKS,
    POINT_LIGHTS_DRAW,
    POINT_LIGHTS_KERNELS
} point_lights_kernel;
typedef enum lists_buffer {
    POINT_LIGHT_RECORDS,
    POINT_LIGHT_MASKS,
    POINT_LIGHT_BOUNDS,
    POINT_LIGHT_BUFFERS
} lists_buffer;

#define POINT_LIGHTS_NAMES(NAME)                                                                   \
    NAME(width), NAME(height), NAME(point_light_count), NAME(point_light_words),                   \
        NAME(point_light_tiles_across), NAME(point_light_picture)
enum { POINT_LIGHTS_NAMES(KERNEL_NAME_ID) };

struct pass_point_lights {
    uint32_t count;
    point_lights_way way;
    gpu_buffer *buffers[POINT_LIGHT_BUFFERS];
    gpu_image *light; // what spheres around the point lights have added up, where the way is
                      // POINT_LIGHTS_VOLUMES
};

// point_lights_volumes.c: where the way is POINT_LIGHTS_VOLUMES
void point_lights_target(const pass *p, size_t index, gpu_graphics_desc *out);
bool point_lights_draw_volumes(pass *p, uint32_t width,
                               uint32_t height); // after the records are made
void point_lights_list_light(const pass *p, uint32_t width, uint32_t height, budget_list *out);
