// Levels of detail: simplified copies of a mesh, drawn where it is small in the picture.
#pragma once
#include "media/mesh.h"

typedef struct mesh_levels {
    uint32_t count;
    float errors[MESH_LEVELS];
    mesh_run *runs[MESH_LEVELS]; // for each part; indices count from those of the mesh itself
    uint32_t ends[MESH_LEVELS];  // of their indices
    uint32_t *indices;           // of all levels
    uint32_t index_count;
} mesh_levels;

// Makes levels from the mesh's vertices, indices and parts, in `memory`. A small mesh gets none,
// and neither does one that would take long.
void mesh_levels_make(const mesh_data *mesh, arena *memory, mesh_levels *out);
