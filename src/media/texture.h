// Textures of meshes: PNG or JPEG, distinguished by their first bytes. The file may be a
// stranger's: the reader decodes it.
#pragma once
#include "media/limits.h"
#include "media/mesh.h"

// Read a texture of at most 16384 pixels a side into `memory`. Of 16 bits the upper 8 are kept.
// False with a message.
bool texture_read_inside(const char *root, const char *path, arena *memory, mesh_texture *out);
bool texture_read_memory(const void *data, size_t size, const char *name, arena *memory,
                         mesh_texture *out);

// Decodes the bytes of a file to RGBA in this process. `name` is for messages.
bool texture_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                    arena *memory, mesh_texture *out);
bool texture_work(const isolate_call *call); // runs in a worker
