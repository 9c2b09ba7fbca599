// Between the parts of a sequence: sequence.c knows its files and their box, sequence_timeline.c
// what is shown when, sequence_channel.c its channels, sequence_raw.c the layout of raw files,
// sequence_decode.c makes texels of a frame on any thread, sequence_atlas.c places bricks of one,
// sequence_upload.c brings them to the device, sequence_jobs.c does both ahead of time,
// sequence_cache.c keeps textures.
//
// A sequence is a grid that fields point at, and its data, which another load of the same effect
// may take over together with the textures and the thread that decodes (field_grid.exchange).
#pragma once
#include "base/budget.h"
#include "base/str.h"
#include "base/worker.h"
#include "field/sequence.h"
#include <pthread.h>

enum {
    SEQUENCE_MAX_JOBS = 32,
    SEQUENCE_TRANSFERS = 4,
    SEQUENCE_MAX_FRAMES = 100000,
};

typedef struct sequence_channel_info {
    const char *name; // as asked for
    int first, components;
    float gain; // of its values: velocities become metres a second
} sequence_channel_info;

typedef struct sequence_raw_layout { // checked: every frame lies inside the file
    uint32_t texel;                  // bytes a value
    int axes[3];                     // the fastest first
    bool backwards[3];               // of these
    uint64_t offset, stride, frame_bytes;
    uint32_t frames;
    int64_t changed; // file_changed_ns
} sequence_raw_layout;

typedef struct sequence_bricks { // of one image
    uint32_t *index;             // of the box, x fastest: where in the atlas; 0: nothing but zeros
    uint32_t count;              // bricks stored
    uint32_t across, layers;     // bricks of the atlas: across * across * layers
} sequence_bricks;

typedef struct sequence_texels {
    uint16_t *images[FIELD_GRID_IMAGES]; // halves, packed as the textures are; sparse: brick after
                                         // brick, 9^3 texels each
    sequence_bricks bricks[FIELD_GRID_IMAGES]; // of a sparse sequence
    box3 active;                               // world
    budget_part *part;                         // of all this memory
    uint64_t voxels;                           // that are not 0
    uint64_t bad;                              // values that were not finite
    vdb_frame read;                            // what images and bricks lie in: of OpenVDB files,
    uint16_t *own;                             // of raw ones
} sequence_texels;

typedef struct sequence_slot { // one frame on the GPU
    uint32_t frame;
    uint64_t used; // turn of the last use; 0: holds nothing
    bool filling;  // a job is about to
    gpu_image *images[FIELD_GRID_IMAGES], *index[FIELD_GRID_IMAGES];
    uint64_t bytes; // of them all
    box3 active;
} sequence_slot;

typedef struct sequence_job { // one frame ahead of time
    const struct sequence_data *owner;
    uint32_t frame;
    enum {
        JOB_QUEUED,   // for decoding
        JOB_DECODING, // by a thread
        JOB_DECODED,
        JOB_STAGING, // a thread has it: writes into memory to copy from
        JOB_STAGED,
        JOB_COPYING, // to the device
        JOB_DROPPED, // freed by the thread that finds it
    } state;
    bool ok;
    char message[1024];
    double seconds; // of decoding
    sequence_texels texels;
    sequence_slot *slot; // that it fills
    gpu_transfer *transfer;
} sequence_job;

typedef struct sequence_jobs {
    worker *pool;
    uint32_t threads;
    pthread_mutex_t lock; // guards the states
    pthread_cond_t done;
    sequence_job *list[SEQUENCE_MAX_JOBS];
    uint32_t wanted[SEQUENCE_MAX_JOBS]; // frames, the next one first
    size_t wanted_count;
} sequence_jobs;

typedef struct sequence_cache {
    sequence_slot *slots;
    size_t slot_count; // 0 until the first frame
    uint64_t budget;   // bytes, beyond which only a few frames are kept
    uint64_t turn;
    uint32_t layers[FIELD_GRID_IMAGES]; // of the largest atlases so far
    sequence_jobs jobs;
    gpu_transfer *idle[SEQUENCE_TRANSFERS]; // to be used again
    field_playback counts;
    bool warned;  // of values that are not finite
    bool limited; // by the device's memory, which was told
} sequence_cache;

typedef struct sequence_data {
    arena memory;
    sequence_desc desc; // defaults filled in
    const char *name;   // for messages
    const char *label;  // of its decoded frames, in the account of memory
    bool raw;
    sequence_raw_layout layout;
    const char **files; // by frame
    size_t file_count;
    const int64_t *times;      // of every file: its frame since the first; NULL: one after another
    int64_t span;              // frames of the timeline
    const vdb_info *infos;     // of every file
    content_cache_item **held; // the same, of desc.content_cache
    size_t held_count;
    uint32_t frame_count;  // that there are
    box3 file_box;         // in file units and axes
    uint32_t file_size[3]; // voxels along the file's axes
    box3 box;              // of the grid
    uint32_t size[3];      // of its textures
    int width;             // channels of its textures, gaps included
    bool sparse;
    uint64_t most_active;  // voxels of the fullest frame, as its file says
    uint32_t atlas_across; // bricks along a side of the atlas, unless a frame needs more
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
// Values of one frame, x fastest, into zeros of the size with padding. Any thread. Those that are
// not finite become 0 and count as bad.
bool sequence_raw_read(const sequence_data *s, uint32_t frame, float *out, uint64_t *bad);

// Which grid of a file a channel is read from: its name, or an alias; NULL when there is none.
// Three scalar grids "vel.x", "vel.y", "vel.z" make a vector: `part` 0..2 asks for one of them.
const vdb_grid_info *sequence_find_grid(const vdb_info *info, const char *channel, int part);
// "density, heat (has a frustum transform)": names, and why those that are not read are not.
void sequence_list_grids(const vdb_info *info, strbuf *out);
// Hooks of its grid: the channels that fields sample, or that were asked for.
const char *sequence_field_name(const field_grid *grid, size_t index);
int sequence_find_field(field_grid *grid, const char *name, int *components);

// How many times as full as this frame the fullest one is.
float sequence_growth(const sequence_data *s, uint32_t frame);
// Sorts the files by the numbers in their names; sets times and span.
void sequence_number_files(sequence_data *s);
double sequence_position(const sequence_data *s, double time); // in frames since the first
// What is there around a position, by index, and the share of the second. False when there is
// nothing to see then.
bool sequence_frames_at(const sequence_data *s, double position, uint32_t frames[2], float *blend);

int sequence_image_channels(const sequence_data *s, int image); // 0..4
int sequence_texel_width(const sequence_data *s, int image);    // components of the texture
uint64_t sequence_brick_count(const sequence_data *s);          // of the box

// Any thread. False with a message; nothing is then left to free.
bool sequence_decode(const sequence_data *s, uint32_t frame, sequence_texels *out);
// Bytes that decoding takes at most, and holds after it; of a sparse frame as its file says.
uint64_t sequence_decode_bytes(const sequence_data *s, uint32_t frame);
// Of the textures of a dense frame, or of what a sparse one holds as far as its file says.
uint64_t sequence_frame_bytes(const sequence_data *s, uint32_t frame);
void sequence_atlas_place(const sequence_data *s, sequence_bricks *bricks);
// The atlas of an image, as its texture takes it: any thread.
void sequence_atlas_write(const sequence_data *s, const sequence_texels *texels, int image,
                          void *out);
void sequence_texels_drop(sequence_texels *texels); // their memory, not what is known of them
void sequence_texels_free(sequence_texels *texels);

// Gives the slot textures that a frame fits into, with room for others if these will follow; false
// with a message.
bool sequence_slot_fit(const sequence_data *s, gpu *g, const sequence_texels *texels, bool others,
                       sequence_slot *slot);
void sequence_slot_free(sequence_slot *slot, gpu *g); // what it holds; `g` may be NULL if nothing
// The bytes of a frame as they are copied into textures.
uint64_t sequence_upload_bytes(const sequence_data *s, const sequence_texels *texels);
void sequence_upload_write(const sequence_data *s, const sequence_texels *texels, void *out);
size_t sequence_upload_parts(const sequence_data *s, const sequence_texels *texels,
                             const sequence_slot *slot,
                             gpu_transfer_part parts[2 * FIELD_GRID_IMAGES]);

// field_grid.exchange of a sequence.
bool sequence_exchange(field_grid *grid, field_grid *other);
void sequence_data_free(sequence_data *d, gpu *g); // `g` may be NULL when nothing was shown

// On the thread of the device, but for what the threads do.
void sequence_jobs_start(sequence_data *s);
void sequence_jobs_end(sequence_data *s, gpu *g);
sequence_job *sequence_job_find(const sequence_data *s, uint32_t frame);
// False: there are enough, or as many as memory allows.
bool sequence_job_add(sequence_data *s, uint32_t frame);
int sequence_job_state(sequence_job *job);
int sequence_job_wait(sequence_job *job);                    // until no thread has it; its state
void sequence_job_stage(sequence_job *job);                  // its transfer is large enough
bool sequence_job_drop(sequence_data *s, sequence_job *job); // frees it; false: a thread has it

// The slot of a frame, decoded and uploaded if need be; NULL with a message. What is shown in one
// turn stays until the next.
void sequence_cache_turn(sequence_data *s);
// Whether so many more bytes may be taken for what is not shown yet: a quarter of the memory is
// left for what is.
bool sequence_may_prepare(gpu *g, uint64_t bytes);
sequence_slot *sequence_cache_get(sequence_data *s, gpu *g, uint32_t frame);
sequence_slot *sequence_cache_nearest(sequence_data *s, uint32_t frame); // NULL: there is none yet
// True with a message when it was decoded ahead and that failed.
bool sequence_cache_failed(sequence_data *s, gpu *g, uint32_t frame);
// Starts decoding frames that will be wanted soon, the next one first; those that wait for a thread
// and are not among them are dropped.
void sequence_cache_ahead(sequence_data *s, const uint32_t *frames, size_t count);
void sequence_cache_pump(sequence_data *s, gpu *g); // brings them on, without waiting
void sequence_cache_free(sequence_data *s, gpu *g);
