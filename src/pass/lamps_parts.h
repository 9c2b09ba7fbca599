// The inside of the lists of lamps (pass/lamps.h), for their own files only.
#pragma once
#include "pass/lamps.h"
#include "pass/pass_impl.h"

typedef enum lists_stage { LISTS_RECORDS, LISTS_MASKS, LISTS_STAGES } lists_stage;
typedef enum lists_buffer { LAMP_RECORDS, LAMP_MASKS, LAMP_BOUNDS, LAMP_BUFFERS } lists_buffer;

typedef struct lamps_volumes { // spheres, drawn around the lamps
    shader_binary vertex, fragment;
    gpu_pipeline *pipeline;
    unsigned char *vertex_block, *fragment_block;
    gpu_image *light; // what they have added up
} lamps_volumes;

struct pass_lamps {
    uint32_t count;
    lamps_way way;
    shader_binary binary[LISTS_STAGES];
    gpu_pipeline *pipeline[LISTS_STAGES];
    unsigned char *block[LISTS_STAGES];
    gpu_buffer *buffers[LAMP_BUFFERS];
    lamps_volumes volumes;
};

// lamps_volumes.c: where the way is LAMPS_VOLUMES
bool lamps_check_volumes(pass *p);
bool lamps_build_volumes(pass *p);
void lamps_destroy_volumes(pass *p);
bool lamps_draw_volumes(pass *p, uint32_t width, uint32_t height); // after the records are made
