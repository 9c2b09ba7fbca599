// March in software: pixels whose rays miss the volume's box, which a cheaper shader fills. Other
// devices end such rays at once; a software device computes a step for each.
#pragma once
#include "pass/pass_impl.h"

typedef struct march_around {
    shader_binary binary;
    gpu_pipeline *pipeline;
    unsigned char *block;
} march_around;

typedef struct march_part { // of the picture, in pixels
    int32_t low[2], high[2];
} march_part;

void march_write_corner(const shader_binary *binary, unsigned char *block, march_part part);

bool march_around_check(pass *p);
bool march_around_build(pass *p, march_around *a);
void march_around_destroy(pass *p, march_around *a);
// Fills all pixels but those of the part that it gives: no ray beside it meets `box`. NULL: it
// fills none.
bool march_around_record(pass *p, march_around *a, box3 box, march_part *inside);
