// Surfaces of the triangles of a forest (bvh_tree.h), for lib/surface.glsl: vertices with normals,
// materials, and the texels of all textures one after the other.
#pragma once
#include "scene/bvh_tree.h"

typedef struct surfaces {    // zero: empty
    shared_uvec4 *triangles; // for each triangle of the forest: its three vertices and its part
    size_t triangle_count, triangle_capacity;
    struct surface_vertex *vertices;
    size_t vertex_count, vertex_capacity;
    struct surface_material *materials; // one for each part of each mesh
    size_t material_count, material_capacity;
    uint16_t (*texels)[4]; // linear, half floats
    size_t texel_count, texel_capacity;
    bool holes; // a material is transparent in places
} surfaces;

// Returns whether the part's colour or texture is transparent in places.
bool surface_has_holes(const mesh_data *mesh, const mesh_part *part);
// Adds surfaces for the forest's triangles up to `end` that have none yet; they belong to `mesh`.
void surfaces_add(surfaces *s, const bvh_forest *f, size_t end, const mesh_data *mesh);
void surfaces_free(surfaces *s);
uint64_t surfaces_texels(const mesh_data *mesh); // of all its textures
// Bytes of the largest array that surfaces of this mesh are made of.
uint64_t surfaces_largest(const mesh_data *mesh);
