// What bloom.c and bloom_gaussian.c share.
#pragma once
#include "pass/pass_impl.h"

typedef enum bloom_stage {
    BLOOM_FIRST,
    BLOOM_DOWN,
    BLOOM_TAIL,
    BLOOM_UP,
    BLOOM_LAST,
    BLOOM_BLUR_FIRST, // from here on: of mode gaussian
    BLOOM_BLUR,
    BLOOM_STAGES,
} bloom_stage;

#define BLOOM_NAMES(NAME)                                                                          \
    NAME(mode), NAME(source), NAME(picture), NAME(color), NAME(levels), NAME(passes), NAME(width), \
        NAME(height), NAME(tail_levels), NAME(radius), NAME(alpha), NAME(down), NAME(threshold),   \
        NAME(knee), NAME(limit), NAME(intensity)
enum { BLOOM_NAMES(KERNEL_NAME_ID), BLOOM_NAME_COUNT, BLOOM_TAKEN = 4 };

typedef struct bloom_state {
    pass *bright; // whose work is done here; NULL: none
    size_t bright_uniforms[BLOOM_TAKEN];
    graph_image picture; // that is read
    bool same_size;      // as the bloom
    bool gaussian;       // the mode
    graph_image across;  // of mode gaussian: blurred across, not yet down
} bloom_state;

bool bloom_record_gaussian(pass *p); // after pass_prepare
