// The voxeliser on the device: its shaders, buffers, and what each dispatch binds.
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

static const struct {
    const char *block, *label;
} names[VOXELS_BUFFERS] = {
    [VOXELS_STATE] = {"VoxelState", "state of voxels"},
    [VOXELS_LISTS] = {"VoxelLists", "bodies by tiles of cells"},
    [VOXELS_POINTS] = {"VoxelPoints", "points of bodies"},
    [VOXELS_ITEMS] = {"VoxelItems", "triangles of bodies"},
    [VOXELS_PLACED] = {"VoxelPlaced", "points in cells"},
    [VOXELS_MASKS] = {"VoxelMasks", "masks of bodies"},
    [VOXELS_IDS] = {"VoxelIds", "ids of cells"},
    [VOXELS_MOTIONS] = {"VoxelMotions", "motions of bodies"},
    [VOXELS_KEYS] = {"VoxelKeys", "nearest triangles"},
    [VOXELS_SEEDS] = {"VoxelSeeds", "nearest points"},
    [VOXELS_OTHER_SEEDS] = {"VoxelNextSeeds", "nearest points"},
};

static int stages_of(const voxels *v) {
    return v->distances ? VOXELS_STAGES : VOXELS_NEAR;
}

bool voxels_compile(voxels *v, shader_library *library, const shader_reader *reader) {
    for (int i = 0; i < stages_of(v); i++)
        if (!shader_compile(library, v->memory,
                            &(shader_compile_desc){
                                .name = shaders[i], .stage = SHADER_COMPUTE, .reader = reader},
                            &v->binaries[i]))
            return false;
    return true;
}

bool voxels_build(voxels *v, gpu *g) {
    for (int i = 0; i < stages_of(v); i++) {
        const shader_binary *binary = &v->binaries[i];
        gpu_slot slots[GPU_MAX_SLOTS];
        for (size_t k = 0; k < binary->slot_count; k++) slots[k] = binary->slots[k].slot;
        gpu_compute_desc desc = {
            .label = shaders[i],
            .code = binary->code,
            .code_size = binary->size,
            .slots = slots,
            .slot_count = binary->slot_count,
        };
        memcpy(desc.local_size, binary->local_size, sizeof desc.local_size);
        v->pipelines[i] = gpu_pipeline_create_compute(g, &desc);
        if (!v->pipelines[i]) return false;
    }
    return true;
}

void voxels_destroy(voxels *v, gpu *g) {
    if (!v) return;
    for (int i = 0; i < VOXELS_STAGES; i++)
        if (v->pipelines[i]) gpu_pipeline_destroy(g, v->pipelines[i]);
    for (int i = 0; i < VOXELS_BUFFERS; i++)
        if (v->buffers[i]) gpu_buffer_destroy(g, v->buffers[i]);
    for (size_t i = 0; i < v->surface_count; i++) voxel_surface_free(&v->surfaces[i]);
    mem_free(v->lists.items);
    v->lists = (voxels_lists){0};
    v->surface_count = 0;
    memset(v->pipelines, 0, sizeof v->pipelines);
    memset(v->buffers, 0, sizeof v->buffers);
}

// ---- buffers ----------------------------------------------------------------------------------

bool voxels_make_buffer(voxels *v, gpu *g, voxels_part_buffer which, uint64_t bytes) {
    uint64_t most = gpu_get_info(g)->max_storage_range;
    if (bytes < 16) bytes = 16; // a buffer is never empty
    if (bytes > most)
        return err_set("voxels: %s take %llu MiB; this device can bind %llu: fewer cells or "
                       "bodies are needed",
                       names[which].label, (unsigned long long)bytes >> 20,
                       (unsigned long long)most >> 20);
    gpu_buffer_desc desc = {.label = names[which].label, .size = bytes, .kind = GPU_BUFFER_DEVICE};
    v->buffers[which] = gpu_buffer_create(g, &desc);
    return v->buffers[which] != NULL;
}

// Points and items of all surfaces, one behind the other.
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

bool voxels_allocate(voxels *v, gpu *g) {
    if (v->buffers[VOXELS_MOTIONS]) return true;
    uint64_t cells = (uint64_t)v->size[0] * v->size[1] * v->size[2];
    uint64_t state = sizeof *v->state + v->part_count * sizeof *v->state->parts;
    return voxels_make_buffer(v, g, VOXELS_STATE, state) &&
           voxels_make_buffer(v, g, VOXELS_POINTS, v->point_count * sizeof(shared_vec4)) &&
           voxels_make_buffer(v, g, VOXELS_ITEMS, v->item_count * sizeof(shared_uvec4)) &&
           voxels_make_buffer(v, g, VOXELS_PLACED, v->placed_count * sizeof(shared_vec4)) &&
           voxels_make_buffer(v, g, VOXELS_MASKS, 16) &&
           voxels_make_buffer(v, g, VOXELS_IDS, 4 * cells) &&
           voxels_make_buffer(v, g, VOXELS_MOTIONS, (v->body_count + 1) * sizeof *v->motions) &&
           write_surfaces(v, g);
}

// ---- dispatching ------------------------------------------------------------------------------

static gpu_buffer *find_buffer(const voxels *v, const char *block, bool other) {
    for (int i = 0; i < VOXELS_BUFFERS; i++) {
        if (strcmp(names[i].block, block) != 0) continue;
        if (other && i >= VOXELS_SEEDS) return v->buffers[VOXELS_SEEDS + VOXELS_OTHER_SEEDS - i];
        return v->buffers[i];
    }
    return NULL;
}

bool voxels_dispatch(voxels *v, gpu *g, voxels_stage stage, const uint32_t threads[3],
                     const voxels_images *more) {
    const shader_binary *binary = &v->binaries[stage];
    gpu_binding bindings[GPU_MAX_SLOTS] = {0};
    const int32_t block[4] = {more->apart}; // the only uniform that there is
    for (size_t i = 0; i < binary->slot_count; i++) {
        const shader_slot *slot = &binary->slots[i];
        gpu_binding *b = &bindings[i];
        b->binding = slot->slot.binding;
        if (slot->slot.kind == GPU_SLOT_STORAGE_BUFFER) {
            b->buffer = find_buffer(v, slot->name, more->other);
        } else if (slot->slot.kind == GPU_SLOT_UNIFORM) {
            b->uniform = block;
            b->uniform_size = slot->size;
        } else {
            b->image = more->image;
        }
    }
    return gpu_dispatch(g, &(gpu_dispatch_desc){
                               .pipeline = v->pipelines[stage],
                               .bindings = bindings,
                               .binding_count = binary->slot_count,
                               .threads = {threads[0], threads[1], threads[2]},
                           });
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
