// Bricks of a pass's density (shaders/lib/bricks.glsl says what they are): a part of the graph that
// runs before the pass. Its shader has the stages STAGE_HOLD and STAGE_FREE that make them, and the
// uniform `bricks`, how many lie along the longest side of the box.
#pragma once
#include "pass/pass_impl.h"

enum { BRICKS_STAGES = 2 };

typedef struct bricks {
    bool dear; // samples of nothing are
    graph_image image;
    shader_binary binary[BRICKS_STAGES];
    gpu_pipeline *pipeline[BRICKS_STAGES];
    unsigned char *block[BRICKS_STAGES];
} bricks;

bool bricks_declare(pass *p, bricks *b, bool (*record)(pass *p)); // adds the part "bricks"
bool bricks_check(pass *p);
bool bricks_build(pass *p, bricks *b);
bool bricks_record(pass *p, bricks *b); // after pass_prepare
void bricks_destroy(pass *p, bricks *b);
// The member brick_blocks of a block, for bricks over `box`; `samples` are to be taken without
// them.
void bricks_fill(pass *p, const bricks *b, const shader_binary *binary, unsigned char *block,
                 box3 box, float samples);
pass_override bricks_slot(const pass *p, const bricks *b); // for the pass that reads them
