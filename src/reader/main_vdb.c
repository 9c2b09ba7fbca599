// roil-reader-vdb: the part of roil-reader that uses OpenVDB, which takes 40 ms to load and starts
// threads of its own.
#include "base/memory.h"
#include "media/vdb_decode.h"
#include "reader/reader.h"

static const reader_job jobs[] = {
    {"vdb info", vdb_info_work, NULL, NULL},
    {"vdb sample", vdb_sample_work, NULL, NULL},
    {"vdb frame", vdb_frame_work, NULL, NULL},
    {"vdb write", vdb_write_work, NULL, NULL},
};

int main(void) {
    vdb_get_ready();
    return reader_serve(jobs, COUNT_OF(jobs));
}
