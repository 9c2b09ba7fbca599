// A copy takes about as long as a few hundred more bytes in the copy before it.
#include "scene/runs.h"
#include <string.h>

enum { GAP = 4 }; // unmarked blocks that a copy goes on over

// Returns the block after a run that begins with a marked block.
static size_t run_end(const uint8_t *marks, size_t first, size_t blocks) {
    size_t end = first + 1;
    for (size_t i = end; i < blocks && i < end + GAP; i++)
        if (marks[i]) end = i + 1;
    return end;
}

bool runs_write(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *array, size_t element,
                size_t count, uint8_t *marks) {
    size_t blocks = run_marks(count);
    for (size_t first = 0; first < blocks; first++) {
        if (!marks[first]) continue;
        size_t end = run_end(marks, first, blocks);
        size_t from = first * RUN_BLOCK, to = end * RUN_BLOCK < count ? end * RUN_BLOCK : count;
        if (!gpu_buffer_write(g, buffer, offset + from * element,
                              (const char *)array + from * element, (to - from) * element))
            return false;
        first = end - 1;
    }
    memset(marks, 0, blocks);
    return true;
}
