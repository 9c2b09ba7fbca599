// Data of the voxeliser, for its own files only.
#pragma once
#include "kernel/kernel.h"
#include "scene/voxels.h"
#include "scene/voxels_mesh.h"

typedef enum voxels_stage {
    VOXELS_PREPARE,
    VOXELS_CROSS,
    VOXELS_COMPOSE,
    VOXELS_NEAR, // from here on only for distances
    VOXELS_START,
    VOXELS_FLOOD,
    VOXELS_DISTANCE,
    VOXELS_STAGES
} voxels_stage;

typedef enum voxels_part_buffer { // by the names of their blocks: voxels_device.c
    VOXELS_STATE,
    VOXELS_LISTS,
    VOXELS_POINTS,
    VOXELS_ITEMS,
    VOXELS_PLACED,
    VOXELS_MASKS,
    VOXELS_IDS,
    VOXELS_KEYS,
    VOXELS_SEEDS, // and the other of a pair, which take turns
    VOXELS_OTHER_SEEDS,
    VOXELS_MOTIONS, // for others
    VOXELS_BUFFERS
} voxels_part_buffer;

typedef struct cell_box { // empty: size[0] is 0
    uint32_t low[3], size[3];
} cell_box;

typedef struct voxels_part { // a group of a body
    size_t body;
    const voxel_group *group;
    uint32_t first_point, first_item; // in the buffers, of its mesh
    uint32_t point_count;             // that it places: all, or none for the body's other parts
    uint32_t first_placed;            // of its body
    uint32_t first_number;            // of its items among those of all parts
    uint32_t masks, capacity, used;   // first uvec4 of its masks; how many there may be; are now
    bool shell;
    cell_box box; // as last voxelised
    bool moved;   // is voxelised now
} voxels_part;

typedef struct voxels_placed { // a body
    voxels_body body;
    size_t surface; // of `surfaces`
    mat4 transform; // as last voxelised
    bool still;     // only a hand moves it
    bool placed, moved;
    voxels_motion motion;
} voxels_placed;

// The buffer "VoxelState".
typedef struct voxels_state {
    struct voxel_head head;
    struct voxel_part parts[];
} voxels_state;

// The buffer "VoxelLists", which state.glsl describes.
typedef struct voxels_lists {
    uint32_t *items;
    size_t count, capacity;
} voxels_lists;

struct voxels {
    arena *memory;
    box3 box;
    float cell[3]; // edges
    uint32_t size[3];
    voxels_placed *bodies;
    size_t body_count;
    voxel_surface *surfaces; // one for each mesh and rule
    struct voxels_source {
        const mesh_vertex *vertices;
        voxels_rule rule;
        uint32_t first_point, first_item; // in the buffers
    } * sources;                          // of the surfaces
    size_t surface_count;
    uint64_t point_count, item_count;    // of all surfaces
    uint64_t placed_count, number_count; // points and items of all bodies
    voxels_part *parts;
    size_t part_count;
    bool started, distances; // an update was made; distances are wanted
    voxels_state *state;
    voxels_lists lists;
    struct voxel_motion *motions; // by id
    bool motions_written;
    voxels_work work;
    kernel kernels[VOXELS_STAGES];
    gpu_buffer *buffers[VOXELS_BUFFERS];
};

// Which parts compose.comp looks at: those whose boxes meet a tile of cells, in order, for each of
// the tiles that `dirty` lies in. Adds to the lists, and says in the head of the state where.
void voxels_list_tiles(voxels *v, const cell_box *dirty);

// Bytes of the masks and of the lists that the first update makes, with bodies as they are at the
// context's time. A body whose place cannot be evaluated counts as nowhere.
void voxels_expect(const voxels *v, const field_context *context, uint64_t *masks, uint64_t *lists);
// How many tiles a box of cells meets, along all axes together.
size_t voxels_count_tiles(const cell_box *box);

// What a stage binds by name besides the buffers.
typedef struct voxels_images {
    gpu_image *image; // the one it writes
    int32_t apart;    // uniform of flood.comp
    bool other;       // reads the other seeds and writes the first
} voxels_images;
bool voxels_dispatch(voxels *v, gpu *g, voxels_stage stage, const uint32_t threads[3],
                     const voxels_images *more);
// Of shaders whose groups are counted by voxel_group() of state.glsl: as many as are wanted, in
// rows that every device can take.
uint32_t voxels_groups(uint64_t threads);
bool voxels_dispatch_groups(voxels *v, gpu *g, voxels_stage stage, uint32_t groups);
// Of `bytes`; too much for the device: a message that says so.
uint64_t voxels_bytes(const voxels *v, voxels_part_buffer which); // 0: not known before an update
bool voxels_make_buffer(voxels *v, gpu *g, voxels_part_buffer which, uint64_t bytes);
