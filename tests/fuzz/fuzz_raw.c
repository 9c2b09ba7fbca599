// Raw sequences: any description of any bytes gives frames or a message. The input begins with the
// description, as `struct head` lays it out; the rest is the file.
#include "field/sequence_parts.h"
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

struct head { // 64 bytes without padding
    char type[4];
    uint32_t size[3], frames;
    float voxel_size, value_scale, scale;
    uint64_t offset, stride;
    double speed, time;
};

static void play(sequence *s, double time) {
    int components;
    uint32_t frames[2];
    float blend;
    if (sequence_channel(s, "density", &components) != 0) __builtin_trap();
    sequence_frames_at(s->data, sequence_position(s->data, time), frames, &blend);
    for (int i = 0; i < 2; i++) {
        if (frames[i] >= s->data->frame_count) __builtin_trap();
        sequence_texels texels;
        if (sequence_decode(s->data, frames[i], &texels)) sequence_texels_free(&texels);
    }
    field_grid *grid = sequence_grid(s);
    grid->update(grid, NULL, time);
    grid->destroy(grid, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct head head;
    if (size < sizeof head) return 0;
    memcpy(&head, data, sizeof head);
    int fd = memfd_create("fuzz.raw", 0);
    char path[64], type[5] = {0};
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    size_t rest = size - sizeof head;
    if (fd < 0 || write(fd, data + sizeof head, rest) != (ssize_t)rest) __builtin_trap();
    memcpy(type, head.type, sizeof head.type);
    arena memory = {0};
    sequence_desc desc = {
        .pattern = path,
        .speed = head.speed,
        .scale = head.scale,
        .loop = (sequence_loop)(size % 4),
        .blend = size % 3 == 0,
        .y_up = size % 5 == 0,
        .max_frame_bytes = 1 << 20,
        .raw = {.type = type,
                .size = {head.size[0], head.size[1], head.size[2]},
                .frames = head.frames,
                .offset = head.offset,
                .stride = head.stride,
                .voxel_size = head.voxel_size,
                .value_scale = head.value_scale},
    };
    sequence *s = sequence_create(&memory, &desc);
    if (s) play(s, head.time);
    arena_free(&memory);
    close(fd);
    return 0;
}
