// Statistics of all sequences of an effect together.
#include "effect/effect_impl.h"

bool effect_playback(const effect *e, field_playback *out) {
    bool any = false;
    *out = (field_playback){0};
    for (size_t i = 0; i < e->grid_count; i++) {
        const field_grid *grid = e->grids[i];
        if (!grid->playback) continue;
        const field_playback *one = grid->playback(grid);
        any = true;
        out->shown += one->shown;
        out->late += one->late;
        out->decoded += one->decoded;
        out->uploaded += one->uploaded;
        out->decoded_bytes += one->decoded_bytes;
        out->uploaded_bytes += one->uploaded_bytes;
        out->decode_seconds += one->decode_seconds;
        out->threads += one->threads;
        out->device_bytes += one->device_bytes;
        out->largest_bytes += one->largest_bytes;
        out->largest_voxels += one->largest_voxels;
        out->waiting = out->waiting || one->waiting;
    }
    return any;
}
