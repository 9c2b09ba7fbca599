// Meshes from OBJ and glTF files, by assimp. Right-handed; Z up (glTF's Y up is rotated).
#pragma once
#include "base/arena.h"
#include "base/maths.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct mesh_vertex { // as the vertex shader reads it: 32 bytes
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
    float specular;        // 0..1, 0.5: reflects 4 percent head on; 0: matte
    float roughness;       // 0..1
    float metallic;        // 0..1
    float emission[3];     // radiance that it gives off
} mesh_part;

typedef struct mesh_run { // of indices
    uint32_t first, count;
} mesh_run;

typedef struct mesh_level { // the mesh with fewer triangles, of the same vertices
    float error;            // metres that it is off, at most, about
    const mesh_run *runs;   // for each part
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
    box3 box;                 // around all vertices: what it says is out of sight is not drawn
    const char *const *files; // all files read, and textures that are missing
    size_t file_count;
} mesh_data;

// `root` confines textures and buffers that the file names. Limits: 64 MiB file, 8 million
// vertices. Node transforms are applied. Fails on a mesh without faces and on non-finite positions.
bool mesh_load(const char *path, const char *root, arena *memory, mesh_data *out);

// Indices of a part at a level: 0: in full, else below 1 + level_count.
mesh_run mesh_get_run(const mesh_data *mesh, uint32_t part, uint32_t level);
// A ball around the box: xyz: metres, in the space of the mesh; w: radius.
void mesh_get_ball(const mesh_data *mesh, float out[4]);
