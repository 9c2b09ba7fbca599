// The voxeliser on the device: its shaders, its buffers, and the bindings of each dispatch.
#include "base/error.h"
#include "base/memory.h"
#include "scene/voxels_impl.h"
#include <string.h>

static const char *const shaders[VOXELS_STAGES] = {
    [VOXELS_PREPARE] = "scene/voxels/prepare.comp",   [VOXELS_CROSS] = "scene/voxels/cross.comp",
    [VOXELS_COMPOSE] = "scene/voxels/compose.comp",   [VOXELS_NEAR] = "scene/voxels/near.comp",
    [VOXELS_START] = "scene/voxels/start.comp",       [VOXELS_FLOOD] = "scene/voxels/flood.comp",
    [VOXELS_DISTANCE] = "scene/voxels/distance.comp",
};

// The order is that of voxels_part_buffer.
#define NAMES(NAME)                                                                                \
    NAME(VoxelState), NAME(VoxelLists), NAME(VoxelPoints), NAME(VoxelItems), NAME(VoxelPlaced),    \
        NAME(VoxelMasks), NAME(VoxelIds), NAME(VoxelKeys), NAME(VoxelSeeds), NAME(VoxelNextSeeds), \
        NAME(values), NAME(apart)
KERNEL_NAMES(NAMES);

const kernel_table voxels_kernel_table = {{names, COUNT_OF(names)}, shaders, COUNT_OF(shaders)};

static const char *const labels[VOXELS_BUFFERS] = {
    [VOXELS_STATE] = "state of voxels",      [VOXELS_LISTS] = "bodies by tiles of cells",
    [VOXELS_POINTS] = "points of bodies",    [VOXELS_ITEMS] = "triangles of bodies",
    [VOXELS_PLACED] = "points in cells",     [VOXELS_MASKS] = "masks of bodies",
    [VOXELS_IDS] = "ids of cells",           [VOXELS_MOTIONS] = "motions of bodies",
    [VOXELS_KEYS] = "nearest triangles",     [VOXELS_SEEDS] = "nearest points",
    [VOXELS_OTHER_SEEDS] = "nearest points",
};

static int stages_of(const voxels *v) {
    return v->distances ? VOXELS_STAGES : VOXELS_NEAR;
}

bool voxels_build(voxels *v, gpu *g, shader_library *library, const shader_reader *reader) {
    for (int i = 0; i < stages_of(v); i++) {
        const shader_compile_desc shader = {.name = shaders[i], .reader = reader};
        if (!kernel_compile_compute(&v->kernels[i], library, v->memory, &shader,
                                    voxels_kernel_table.names) ||
            (g && !kernel_build(&v->kernels[i], g)))
            return false;
    }
    return true;
}

void voxels_destroy(voxels *v, gpu *g) {
    if (!v) return;
    for (int i = 0; i < VOXELS_STAGES; i++) kernel_destroy(&v->kernels[i], g);
    for (int i = 0; i < VOXELS_BUFFERS; i++)
        if (v->buffers[i]) gpu_buffer_destroy(g, v->buffers[i]);
    for (size_t i = 0; i < v->surface_count; i++) voxel_surface_free(&v->surfaces[i]);
    mem_free(v->lists.items);
    v->lists = (voxels_lists){0};
    v->surface_count = 0;
    memset(v->buffers, 0, sizeof v->buffers);
}

// ---- buffers ----------------------------------------------------------------------------------

bool voxels_make_buffer(voxels *v, gpu *g, voxels_part_buffer which, uint64_t bytes) {
    uint64_t most = gpu_get_info(g)->max_storage_range;
    if (bytes < 16) bytes = 16; // a buffer is never empty
    if (bytes > most)
        return err_set("voxels: %s take %llu MiB; this device can bind %llu: fewer cells or "
                       "bodies are needed",
                       labels[which], (unsigned long long)bytes >> 20,
                       (unsigned long long)most >> 20);
    gpu_buffer_desc desc = {.label = labels[which], .size = bytes, .kind = GPU_BUFFER_DEVICE};
    v->buffers[which] = gpu_buffer_create(g, &desc);
    return v->buffers[which] != NULL;
}

// Writes the points and items of all surfaces, one after the other.
static bool write_surfaces(voxels *v, gpu *g) {
    for (size_t i = 0; i < v->surface_count; i++) {
        const voxel_surface *s = &v->surfaces[i];
        const struct voxels_source *source = &v->sources[i];
        if (s->item_count == 0) continue;
        if (!gpu_buffer_write(g, v->buffers[VOXELS_POINTS],
                              (uint64_t)source->first_point * sizeof *s->points, s->points,
                              s->point_count * sizeof *s->points) ||
            !gpu_buffer_write(g, v->buffers[VOXELS_ITEMS],
                              (uint64_t)source->first_item * sizeof *s->items, s->items,
                              s->item_count * sizeof *s->items))
            return false;
    }
    return true;
}

uint64_t voxels_bytes(const voxels *v, voxels_part_buffer which) {
    const uint64_t cells = (uint64_t)v->size[0] * v->size[1] * v->size[2];
    switch (which) {
    case VOXELS_STATE:
        return sizeof *v->state + v->part_count * sizeof *v->state->parts;
    case VOXELS_POINTS:
        return v->point_count * sizeof(shared_vec4);
    case VOXELS_ITEMS:
        return v->item_count * sizeof(shared_uvec4);
    case VOXELS_PLACED:
        return v->placed_count * sizeof(shared_vec4);
    case VOXELS_IDS:
        return 4 * cells;
    case VOXELS_MOTIONS:
        return (v->body_count + 1) * sizeof *v->motions;
    case VOXELS_KEYS:
        return 4 * cells;
    case VOXELS_SEEDS:
    case VOXELS_OTHER_SEEDS:
        return 16 * cells;
    default:
        return 0; // made when bodies are placed: voxels_expect
    }
}

bool voxels_allocate(voxels *v, gpu *g) {
    static const voxels_part_buffer first[] = {VOXELS_STATE,  VOXELS_POINTS, VOXELS_ITEMS,
                                               VOXELS_PLACED, VOXELS_MASKS,  VOXELS_IDS,
                                               VOXELS_MOTIONS};
    if (v->buffers[VOXELS_MOTIONS]) return true;
    for (size_t i = 0; i < COUNT_OF(first); i++)
        if (!voxels_make_buffer(v, g, first[i], voxels_bytes(v, first[i]))) return false;
    return write_surfaces(v, g);
}

void voxels_list_memory(const voxels *v, const field_context *context, bool distances,
                        budget_list *out) {
    uint64_t masks, lists;
    for (voxels_part_buffer i = 0; i < VOXELS_BUFFERS; i++) {
        const bool far = i >= VOXELS_KEYS && i <= VOXELS_OTHER_SEEDS;
        if (!v->buffers[i] && (distances || !far))
            budget_list_add(out, labels[i], voxels_bytes(v, i));
    }
    if (v->started) return; // these are there
    voxels_expect(v, context, &masks, &lists);
    budget_list_add(out, labels[VOXELS_MASKS], masks);
    budget_list_add(out, labels[VOXELS_LISTS], lists);
}

// ---- dispatching ------------------------------------------------------------------------------

bool voxels_dispatch(voxels *v, gpu *g, voxels_stage stage, const uint32_t threads[3],
                     const voxels_images *more) {
    kernel *k = &v->kernels[stage];
    for (int i = 0; i < VOXELS_MOTIONS; i++) {
        const bool turned = more->other && i >= VOXELS_SEEDS;
        kernel_bind_buffer(k, i, v->buffers[turned ? VOXELS_SEEDS + VOXELS_OTHER_SEEDS - i : i]);
    }
    if (more->image) kernel_bind_image(k, N_values, more->image);
    kernel_set_int(k, N_apart, more->apart);
    return kernel_run(k, g, threads[0], threads[1], threads[2]);
}

uint32_t voxels_groups(uint64_t threads) {
    return (uint32_t)((threads + VOXEL_GROUP - 1) / VOXEL_GROUP);
}

bool voxels_dispatch_groups(voxels *v, gpu *g, voxels_stage stage, uint32_t groups) {
    enum { ROW = 32768 };
    if (groups == 0) return true;
    const uint32_t threads[3] = {VOXEL_GROUP * (groups < ROW ? groups : ROW),
                                 (groups + ROW - 1) / ROW, 1};
    return voxels_dispatch(v, g, stage, threads, &(voxels_images){0});
}
