// Assimp's access to files: it can only read whole files, which are asked for over the worker's
// channel.
#pragma once
#include "base/isolate.h"
#include <assimp/cfileio.h>

typedef struct mesh_io {
    struct aiFileIO io; // pass to assimp; first, so that a pointer to it is one to all
    const isolate_call *call;
    char refused[128]; // why a file was not given to assimp; "" when none was refused
} mesh_io;

void mesh_io_open(mesh_io *io, const isolate_call *call);
