// The inside of what is drawn, for drawn*.c only.
#pragma once
#include "pass/surfaces/drawn.h"
#include "scene/material.h"
#include "shared.h"

typedef struct drawn_place {
    mat4 matrix; // to the world
    scene_look look;
} drawn_place;

// Buffers of shaders/pass/drawn/, of all views.
enum {
    DRAWN_BUCKETS, // the only one that the host writes in each frame, if at all
    DRAWN_CHOICES,
    DRAWN_TOTALS,
    DRAWN_COUNTS,
    DRAWN_FIRSTS,
    DRAWN_LIST,
    DRAWN_COMMANDS,
    DRAWN_BUFFERS
};

// What is chosen from and listed together: instances, or all meshes that stand by themselves. Such
// a mesh is the only instance of its kind, and stands where its kind does.
typedef struct drawn_body {
    scene_instances *instances; // NULL: meshes
    scene_mesh *const *kinds;
    size_t kind_count;
    uint32_t count;      // of instances
    drawn_place *places; // as of this frame, for each kind; of instances all at one place
    uint32_t *commands;  // of a kind: the first; its parts one after the other, each at all levels
    uint32_t command_count; // of a view
    gpu_buffer *entries;    // of meshes: their instances
    gpu_buffer *buffers[DRAWN_BUFFERS];
    struct drawn_bucket *buckets; // as they were written last; NULL: never
} drawn_body;

typedef enum drawn_step { DRAWN_CHOOSE, DRAWN_COUNT, DRAWN_PUT } drawn_step;

#define DRAWN_NAMES(NAME)                                                                          \
    NAME(Views), NAME(Instances), NAME(InstanceList), NAME(DrawnFirsts), NAME(Part),               \
        NAME(Vertices), NAME(mesh_texture), NAME(DrawnBuckets), NAME(DrawnChoices),                \
        NAME(DrawnTotals), NAME(DrawnCounts), NAME(DrawnCommands), NAME(instance_count),           \
        NAME(bucket_count), NAME(block_count), NAME(command_count), NAME(place), NAME(scale),      \
        NAME(lod), NAME(most)
enum { DRAWN_NAMES(KERNEL_NAME_ID) };

struct drawn {
    pass *p;
    drawn_body *bodies;
    size_t body_count;
    size_t first;       // of the kernels that choose
    bool alike;         // parts are drawn as one
    gpu_buffer *camera; // the view of the camera
    gpu_buffer *views;  // of this frame
    size_t capacity;    // of views that there are buffers for
    bool levels;        // of this frame: meshes may be simplified

    // Of the call that is being recorded.
    gpu_draw *draws;
    gpu_binding *bindings;
    struct drawn_part *parts;
    size_t draw_count, draw_capacity, binding_capacity, part_capacity;
};

gpu_buffer *drawn_buffer(gpu *device, const char *label, const void *data, size_t size);
void drawn_list_lists(const drawn_body *body, size_t views, budget_list *out); // of drawn_cull
uint32_t drawn_level_count(const mesh_data *mesh);                             // with the full one
gpu_buffer *drawn_entries(const drawn_body *body);                             // of its instances
