// The inside of an effect, for the files of this layer only.
#pragma once
#include "effect/effect.h"

void effect_copy_settings(effect *e, const effect_setting *settings, size_t count);
// Applies the settings that name this pass; called before it enters the graph.
bool effect_apply_settings(void *user, pass *p);

typedef struct effect_baked { // grid first: a field_grid that a pass fills
    field_grid grid;
    effect *owner;
    const field *node;
} effect_baked;

struct effect {
    arena memory;
    gpu *device;
    const char *file, *root, *name;
    shader_library *library;
    scene scene;
    graph *graph;
    pass_host host;

    double fps;
    uint32_t frames, first, seed;

    effect_param *params;
    float (*values)[4]; // of the params, as field_context wants them
    size_t param_count, param_capacity, value_capacity;
    pass **passes;
    size_t pass_count, pass_capacity;
    field_grid **grids;
    size_t grid_count, grid_capacity;
    scene_mesh **meshes;
    size_t mesh_count, mesh_capacity;
    const char **files;
    size_t file_count, file_capacity;

    graph_image pictures[3]; // by effect_picture
    effect_hooks hooks;

    // Of the frame being recorded.
    field_context context;
    struct frame_block frame;
    uint32_t width, height;
    uint32_t counter;  // frames rendered so far
    double last_frame; // number of the frame rendered last
    bool built;
    const effect_setting *settings;
    bool *applied; // one per setting
    size_t setting_count;
};
