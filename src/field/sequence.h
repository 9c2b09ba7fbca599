// Sequences of volume files played back as a grid: OpenVDB files or one raw file of many frames.
#pragma once
#include "base/arena.h"
#include "base/content_cache.h"
#include "field/grid.h"
#include "media/vdb.h"

typedef enum sequence_loop {
    SEQUENCE_CLIP,
    SEQUENCE_EXTEND,
    SEQUENCE_REPEAT,
    SEQUENCE_PING_PONG
} sequence_loop;
const char *sequence_loop_name(sequence_loop loop); // "clip", "extend", "repeat", "ping_pong"

typedef enum sequence_storage { // of a frame on the device
    SEQUENCE_AUTO,              // whichever takes less memory, dense where it matters little
    SEQUENCE_DENSE,             // every voxel of the box
    SEQUENCE_SPARSE,            // bricks of voxels where there is something
} sequence_storage;

typedef struct sequence_desc {
    const char *pattern;      // absolute path or glob of .vdb files, or a .raw file
    const char *root;         // the files must lie in this folder; NULL: anywhere
    double fps;               // frames of the sequence a second of effect time; 0: 24
    double start;             // effect time (s) at which the first frame is shown
    double speed;             // 0: 1
    sequence_storage storage; // of VDB files; raw ones are dense
    vdb_set level_set;        // of VDB files
    sequence_loop loop; // clip: nothing outside the range; extend: holds the first and last frame
    bool blend;         // mix neighbouring frames at times between them
    bool y_up;          // files have Y up: rotated to our Z up
    bool up_by_creator; // instead: what the first VDB file says by who made it
    float scale;        // metres a world unit of the file; 0: 1
    float3 offset;      // metres, added after scaling
    content_cache *contents; // keeps what files say of themselves between loads; NULL: none
    // Memory limits, checked before anything is read.
    uint64_t max_frame_bytes; // 0: 512 MiB
    // Raw files only:
    struct {
        const char *type; // "u8", "u16", "f16", "f32"
        uint32_t size[3]; // voxels along x, y and z
        // Along which axes the voxels follow each other, the one that varies fastest first; '-'
        // before one that runs backwards: "x-yz". NULL: "xyz".
        const char *axes;
        box3 box;         // metres that these voxels cover; of no extent: from 0, by voxel_size
        uint32_t padding; // voxels of nothing around them
        uint32_t frames;  // 0: as many as the file holds
        uint64_t offset, stride; // bytes to the first frame; from frame to frame (0: tight)
        float voxel_size;        // metres; 0: 1 / size[0]
        float value_scale;       // multiplies values; u8 and u16 are first normalised to 0..1; 0: 1
        const char *channel;     // name of its only channel; NULL: "density"
    } raw;
} sequence_desc;

typedef struct sequence sequence;

// Reads names, boxes and grid names of every file (metadata only, no voxels) and encloses them in
// one box, so that the volume does not jump from frame to frame. The last number in a file's name
// is its frame, where nothing else in the names differs, and the least is the first of the
// timeline; else files follow by name, a frame each. A warning names the frames that have no file.
sequence *sequence_create(arena *memory, const sequence_desc *desc);
// Asks for a channel by canonical name or alias (conventions: "density" also finds "smoke").
// Returns its first channel index in the grid, and 1 or 3 components; -1 with a message that lists
// the grids there are. Only channels asked for are decoded and uploaded.
int sequence_channel(sequence *s, const char *name, int *components);
field_grid *sequence_grid(sequence *s); // its destroy frees all but `memory`, and must be called
bool sequence_is_sparse(const sequence *s);
bool sequence_says_y_up(const sequence *s); // the first file, by its creator
// Whether a file has a grid of numbers of that very name, as it said when the sequence was made.
bool sequence_has_numbers(const sequence *s, size_t file, const char *grid);
int64_t sequence_frame_count(const sequence *s); // of its timeline, those without a file included
double sequence_duration(const sequence *s);     // seconds at speed 1
// Every file it reads, by frame, for a reload to watch; returns the count.
size_t sequence_files(const sequence *s, const char *const **out);
// Which of them is shown at a frame of the timeline.
size_t sequence_file_at(const sequence *s, int64_t frame);
