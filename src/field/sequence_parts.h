// Between the parts of a sequence: sequence.c knows its files, channels and timeline,
// sequence_raw.c the layout of raw files, sequence_decode.c makes texels of a frame on any thread,
// sequence_cache.c keeps textures and decodes ahead.
#pragma once
#include "base/worker.h"
#include "field/sequence.h"
#include "media/vdb.h"
#include <pthread.h>

enum { SEQUENCE_MAX_JOBS = 4, SEQUENCE_MAX_FRAMES = 100000 };

typedef struct sequence_channel_info {
    const char *name; // as asked for
    int first, components;
    float gain; // of its values: velocities become metres a second
} sequence_channel_info;

typedef struct sequence_raw_layout { // checked: every frame lies inside the file
    uint32_t texel;                  // bytes a value
    uint64_t offset, stride, frame_bytes;
    uint32_t frames;
} sequence_raw_layout;

typedef struct sequence_texels {
    uint16_t *images[FIELD_GRID_IMAGES]; // halves, packed as the textures are; mem_free
    box3 active;                         // world
    uint64_t bad;                        // values that were not finite
} sequence_texels;

typedef struct sequence_job { // decoding one frame ahead
    const sequence *owner;
    uint32_t frame;
    enum { JOB_QUEUED, JOB_RUNNING, JOB_DONE, JOB_CANCELLED } state;
    bool ok;
    char message[1024];
    sequence_texels texels;
} sequence_job;

typedef struct sequence_slot { // one frame on the GPU
    uint32_t frame;
    uint64_t used; // turn of the last use; 0: holds nothing
    gpu_image *images[FIELD_GRID_IMAGES];
    box3 active;
} sequence_slot;

typedef struct sequence_cache {
    sequence_slot *slots;
    size_t slot_count; // 0 until the first frame
    uint64_t turn;
    worker *thread;
    pthread_mutex_t lock; // guards the state of jobs
    pthread_cond_t done;
    sequence_job *jobs[SEQUENCE_MAX_JOBS];
    bool warned; // of values that are not finite
} sequence_cache;

struct sequence {
    field_grid grid; // first: a grid's address is its sequence's
    arena *memory;
    sequence_desc desc; // defaults filled in
    bool raw;
    sequence_raw_layout layout;
    const char *const *files;
    size_t file_count;
    const vdb_info *infos; // of every file
    uint32_t frame_count;
    box3 file_box;         // in file units and axes
    uint32_t file_size[3]; // voxels along the file's axes
    sequence_channel_info channels[4 * FIELD_GRID_IMAGES];
    size_t channel_count;
    bool sealed; // textures exist: no more channels
    double last_position;
    sequence_cache cache;
};

// Reads a raw file's length and checks that all frames fit. Sets layout, frame_count, size, box.
bool sequence_raw_open(sequence *s);
// Values of one frame, x fastest. Any thread. Those that are not finite become 0 and count as bad.
bool sequence_raw_read(const sequence *s, uint32_t frame, float *out, uint64_t *bad);

// Which grid of a file a channel is read from: its name, or an alias; NULL when there is none.
// Three scalar grids "vel.x", "vel.y", "vel.z" make a vector: `part` 0..2 asks for one of them.
const vdb_grid_info *sequence_find_grid(const vdb_info *info, const char *channel, int part);

// The frames around a time and the share of the second. False when there is nothing to see then.
bool sequence_frames_at(const sequence *s, double time, uint32_t frames[2], float *blend);

int sequence_image_channels(const sequence *s, int image); // 0..4

// Any thread. False with a message; nothing is then left to free.
bool sequence_decode(const sequence *s, uint32_t frame, sequence_texels *out);
void sequence_texels_free(sequence_texels *texels);

// The slot of a frame, decoded and uploaded if need be; NULL with a message. A slot lives until
// two more turns have passed.
sequence_slot *sequence_cache_get(sequence *s, gpu *g, uint32_t frame);
// Starts decoding frames that will be wanted soon; work on others is dropped.
void sequence_cache_ahead(sequence *s, const uint32_t *frames, size_t count);
void sequence_cache_free(sequence *s, gpu *g);
