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

typedef struct bloom_state {
    pass *bright;           // whose work is done here; NULL: none
    graph_image picture;    // that is read
    bool same_size;         // as the bloom
    bloom_stage begin, end; // stages of the mode
    graph_image across;     // of mode gaussian: blurred across, not yet down
    shader_binary binary[BLOOM_STAGES];
    gpu_pipeline *pipeline[BLOOM_STAGES];
    unsigned char *block[BLOOM_STAGES];
} bloom_state;

// An image of the pass at its scale.
graph_image bloom_add_image(pass *p, const char *name, uint32_t mips);
void bloom_write_int(pass *p, bloom_stage stage, const char *name, uint32_t value);
bool bloom_record_gaussian(pass *p); // its blocks are filled
