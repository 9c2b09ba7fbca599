// What the files of the pass type `march` share; and march_around.c.
//
// In software, pixels whose rays miss the volume's box are filled by a cheaper kernel. Other
// devices end such rays at once; a software device computes a step for each.
#pragma once
#include "pass/pass_impl.h"

typedef enum march_kernel {
    MARCH_RAYS,
    MARCH_HOLD,
    MARCH_FREE,
    MARCH_AROUND,
    MARCH_KERNELS
} march_kernel;

#define MARCH_NAMES(NAME)                                                                          \
    NAME(mode), NAME(view), NAME(skipping), NAME(steps), NAME(tolerance), NAME(threads),           \
        NAME(bricks), NAME(color), NAME(brick_words), NAME(bricks_kept), NAME(brick_blocks),       \
        NAME(brick_rows), NAME(team), NAME(corner)
enum { MARCH_NAMES(KERNEL_NAME_ID) };

typedef struct march_part { // of the picture, in pixels
    int32_t low[2], high[2];
} march_part;

void march_set_corner(kernel *k, march_part part);

// Fills all pixels but those of the part that it gives: no ray beside it meets `box`.
bool march_around_record(pass *p, box3 box, march_part *inside);
