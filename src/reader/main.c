// roil-reader: reads what strangers wrote. See base/isolate.h.
#include "base/memory.h"
#include "media/exr.h"
#include "media/mesh_import.h"
#include "media/png.h"
#include "media/texture.h"
#include "reader/reader.h"
#include "shader/compiler.h"

static const reader_job jobs[] = {
    {"glsl", compiler_work, compiler_get_ready},
    {"mesh", mesh_import, NULL},
    {"exr", exr_work, NULL},
    {"png", png_work, NULL},
    {"texture", texture_work, NULL},
    {"png texts", png_texts_work, NULL},
};

int main(void) {
    return reader_serve(jobs, COUNT_OF(jobs));
}
