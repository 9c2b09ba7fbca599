// Between the parts of a sequence: sequence.c knows its files, channels and timeline,
// sequence_raw.c the layout of raw files, sequence_decode.c makes texels of a frame on any thread,
// sequence_cache.c keeps textures and decodes ahead.
//
// A sequence is a grid that fields point at, and its data, which another load of the same effect
// may take over together with the textures and the thread that decodes (field_grid.exchange).
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
    int64_t changed; // file_changed_ns
} sequence_raw_layout;

typedef struct sequence_texels {
    uint16_t *images[FIELD_GRID_IMAGES]; // halves, packed as the textures are; mem_free
    box3 active;                         // world
    uint64_t bad;                        // values that were not finite
} sequence_texels;

typedef struct sequence_job { // decoding one frame ahead
    const struct sequence_data *owner;
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

typedef struct sequence_data {
    arena memory;
    sequence_desc desc; // defaults filled in
    const char *name;   // for messages
    bool raw;
    sequence_raw_layout layout;
    const char *const *files;
    size_t file_count;
    const vdb_info *infos; // of every file
    shelf_item **held;     // the same, of desc.shelf
    size_t held_count;
    uint32_t frame_count;
    box3 file_box;         // in file units and axes
    uint32_t file_size[3]; // voxels along the file's axes
    box3 box;              // of the grid
    uint32_t size[3];      // of its textures
    int width;             // channels of its textures, gaps included
    sequence_channel_info channels[4 * FIELD_GRID_IMAGES];
    size_t channel_count;
    double last_position;
    sequence_cache cache;
} sequence_data;

struct sequence {
    field_grid grid; // first: a grid's address is its sequence's
    sequence_data *data;
    bool sealed; // textures exist: no more channels
};

// Reads a raw file's length and checks that all frames fit. Sets layout, frame_count, size, box.
bool sequence_raw_open(sequence_data *s);
// Values of one frame, x fastest. Any thread. Those that are not finite become 0 and count as bad.
bool sequence_raw_read(const sequence_data *s, uint32_t frame, float *out, uint64_t *bad);

// Which grid of a file a channel is read from: its name, or an alias; NULL when there is none.
// Three scalar grids "vel.x", "vel.y", "vel.z" make a vector: `part` 0..2 asks for one of them.
const vdb_grid_info *sequence_find_grid(const vdb_info *info, const char *channel, int part);

// The frames around a time and the share of the second. False when there is nothing to see then.
bool sequence_frames_at(const sequence_data *s, double time, uint32_t frames[2], float *blend);

int sequence_image_channels(const sequence_data *s, int image); // 0..4

// Any thread. False with a message; nothing is then left to free.
bool sequence_decode(const sequence_data *s, uint32_t frame, sequence_texels *out);
void sequence_texels_free(sequence_texels *texels);

// field_grid.exchange of a sequence.
bool sequence_exchange(field_grid *grid, field_grid *other);
void sequence_data_free(sequence_data *d, gpu *g); // `g` may be NULL when nothing was shown

// The slot of a frame, decoded and uploaded if need be; NULL with a message. A slot lives until
// two more turns have passed.
sequence_slot *sequence_cache_get(sequence_data *s, gpu *g, uint32_t frame);
// Starts decoding frames that will be wanted soon; work on others is dropped.
void sequence_cache_ahead(sequence_data *s, const uint32_t *frames, size_t count);
void sequence_cache_free(sequence_data *s, gpu *g);
