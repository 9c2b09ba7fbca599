// Imports a mesh by assimp. It runs in a worker of the reader (base/isolate.h), because assimp 5.2
// crashes on many damaged files. The result is sent as bytes, in this order:
//   mesh_blob, mesh_part[part_count], mesh_vertex[vertex_count], uint32_t[index_count and
//   level_index_count], mesh_run[level_count times part_count], texture_count times
//   mesh_blob_texture and its bytes.
#pragma once
#include "base/isolate.h"
#include "media/mesh.h"

typedef struct mesh_blob {
    uint32_t part_count, vertex_count, index_count, texture_count;
    uint32_t level_count, level_index_count;
    float errors[MESH_LEVELS];
} mesh_blob; // a part's texture is an index into the textures that follow, or -1

typedef enum mesh_texture_kind {
    MESH_TEXTURE_NAME,   // a file, named relative to the mesh
    MESH_TEXTURE_FILE,   // a whole file that was embedded
    MESH_TEXTURE_TEXELS, // RGBA
} mesh_texture_kind;

typedef struct mesh_blob_texture {
    uint32_t kind, width, height, size; // bytes that follow
} mesh_blob_texture;

enum { MESH_VERTICES_MAX = 8 << 20, MESH_INDICES_MAX = 64 << 20, MESH_TEXTURES_MAX = 256 };

// Runs in a worker. The input is the name that assimp uses for the file: "./" and its path below
// the root (mesh.c). The file itself is asked for like those that it names.
bool mesh_import(const isolate_call *call);
