// The pass type `deposit`: particles as the density of a grid that fields sample.
#pragma once
#include "pass/pass.h"

typedef struct pass_deposit_desc {
    box3 box;            // metres
    uint32_t resolution; // cells along the longest side, which are about cubes
} pass_deposit_desc;

enum { PASS_DEPOSIT_LEAST = 4, PASS_DEPOSIT_MOST = 512 }; // resolution

// Before pass_declare; then the grid is the effect's. NULL with a message.
field_grid *pass_deposit_open(pass *p, const pass_deposit_desc *desc);
