// Bricks of a march's density (shaders/lib/bricks.glsl says what they are): a part of the graph
// that runs before the march.
#pragma once
#include "pass/pass_impl.h"

typedef struct bricks {
    bool dear; // samples of nothing are
    graph_image image;
    float blocks[3]; // of this frame
} bricks;

bool bricks_declare(pass *p, bricks *b, bool (*record)(pass *p)); // adds the part "bricks"
bool bricks_record(pass *p, bricks *b);                           // after pass_prepare
// How many lie in `box`; `samples` are to be taken without them.
void bricks_update(pass *p, bricks *b, box3 box, float samples);
void bricks_bind(const pass *p, const bricks *b, kernel *k); // for the kernel that reads them
