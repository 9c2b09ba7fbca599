// roil-reader: reads files of strangers for another process. See base/isolate.h.
#include "base/memory.h"
#include "media/exr.h"
#include "media/mesh_import.h"
#include "media/png.h"
#include "media/texture.h"
#include "media/vdb_decode.h"
#include "reader/reader.h"
#include "shader/compiler.h"

static const char vdb[] = "roil-reader-vdb"; // main_vdb.c

static const reader_job jobs[] = {
    {"glsl", compiler_work, compiler_get_ready, NULL},
    {"mesh", mesh_import, NULL, NULL},
    {"exr", exr_work, NULL, NULL},
    {"exr size", exr_size_work, NULL, NULL},
    {"png", png_work, NULL, NULL},
    {"texture", texture_work, NULL, NULL},
    {"png size", png_size_work, NULL, NULL},
    {"png texts", png_texts_work, NULL, NULL},
    {"vdb heads", vdb_heads_work, NULL, NULL},
    {"vdb info", NULL, NULL, vdb},
    {"vdb sample", NULL, NULL, vdb},
    {"vdb frame", NULL, NULL, vdb},
    {"vdb write", NULL, NULL, vdb},
};

int main(void) {
    return reader_serve(jobs, COUNT_OF(jobs));
}
