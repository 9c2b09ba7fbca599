// A few words that kernels find, and that the host reads some frames later without waiting: they
// write an image of one row, which is copied to one of as many places as frames can be in flight.
#pragma once
#include "gpu/gpu.h"

enum { KERNEL_READBACK_PLACES = GPU_FRAMES_IN_FLIGHT + 1 };

typedef struct kernel_readback { // zero: not made
    gpu_image *image;            // GPU_R32U, for kernels to write
    gpu_buffer *found;
    uint32_t words, next;
    struct {
        uint64_t frame, tag; // frame 0: nothing was sent
    } places[KERNEL_READBACK_PLACES];
} kernel_readback;

// Makes it, if that was not done yet. False with a message.
bool kernel_readback_make(kernel_readback *r, gpu *g, const char *label, uint32_t words);
void kernel_readback_destroy(kernel_readback *r, gpu *g);

// Sends what the image holds now, in a frame. `tag` comes back with it.
bool kernel_readback_send(kernel_readback *r, gpu *g, uint64_t tag);
bool kernel_readback_sent(const kernel_readback *r); // something, since it was made or forgotten
void kernel_readback_forget(kernel_readback *r);
// Returns the words of the newest that is done; NULL: there is none.
const void *kernel_readback_newest(const kernel_readback *r, gpu *g, uint64_t *tag);
