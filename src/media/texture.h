// Textures of meshes: PNG or JPEG, told apart by their first bytes. The file may be a stranger's:
// the reader decodes it.
#pragma once
#include "media/limits.h"
#include "media/mesh.h"

// At most 16384 pixels a side. Sixteen bits lose their low byte: textures are shown, not measured.
// False with a message.
bool texture_read_inside(const char *root, const char *path, arena *memory, mesh_texture *out);
bool texture_read_memory(const void *data, size_t size, const char *name, arena *memory,
                         mesh_texture *out);

// Here and now, a file's bytes, as RGBA; `name` is for messages.
bool texture_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                    arena *memory, mesh_texture *out);
bool texture_work(const isolate_call *call); // in a worker
