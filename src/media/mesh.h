// Meshes from OBJ and glTF files, read by assimp. Coordinates are right-handed with Z up; glTF's Y
// up is rotated. Lengths are metres.
#pragma once
#include "base/arena.h"
#include "base/maths.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct mesh_vertex { // 32 bytes, as the vertex shader reads it
    float position[3], u;
    float normal[3], v;
} mesh_vertex;

typedef struct mesh_texture { // RGBA, 8 bits, sRGB
    uint32_t width, height;
    const uint8_t *pixels;
} mesh_texture;

typedef struct mesh_part { // a run of indices with one material
    uint32_t first, count; // indices
    float color[4];        // base colour, linear
    int texture;           // index, -1: none
    float specular;        // 0 to 1; 0.5 reflects 4 percent at normal incidence, 0 is matte
    float roughness;       // 0 to 1
    float metallic;        // 0 to 1
    float emission[3];     // emitted radiance
} mesh_part;

typedef struct mesh_run { // a range of indices
    uint32_t first, count;
} mesh_run;

typedef struct mesh_level { // the mesh with fewer triangles and the same vertices
    float error;            // about the greatest distance from the full mesh (m)
    const mesh_run *runs;   // one for each part
} mesh_level;

enum { MESH_LEVELS = 3 };

typedef struct mesh_data {
    const mesh_vertex *vertices;
    uint32_t vertex_count;
    const uint32_t *indices; // triangles, counter-clockwise; those of the levels come last
    uint32_t index_count;    // without those of the levels
    uint32_t level_index_count;
    mesh_level levels[MESH_LEVELS]; // each coarser than the one before it
    uint32_t level_count;
    const mesh_part *parts;
    uint32_t part_count;
    const mesh_texture *textures;
    uint32_t texture_count;
    box3 box;                 // encloses all vertices; used for culling
    const char *const *files; // all files that were read, and textures that are missing
    size_t file_count;
} mesh_data;

// Loads a mesh into `memory`. Textures and buffers that the file names must lie below `root`.
// Limits: files of 64 MiB, 8 million vertices. Node transforms are applied. False with a message,
// also for a mesh without faces or with non-finite positions.
bool mesh_load(const char *path, const char *root, arena *memory, mesh_data *out);

// Returns the indices of a part at a level, 0 (the full mesh) to level_count.
mesh_run mesh_get_run(const mesh_data *mesh, uint32_t part, uint32_t level);
// Returns a sphere around the box: centre (m, in the space of the mesh) and radius (w).
void mesh_get_ball(const mesh_data *mesh, float out[4]);
