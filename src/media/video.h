// Writes MP4 files frame by frame: H.264 where the encoder exists, else MPEG-4 part 2.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct video video;

// Begins a file. Odd sizes are padded by one row or column. The file appears under its name only
// when it is finished. NULL with a message.
video *video_create(const char *path, uint32_t width, uint32_t height, double fps);
bool video_add(video *v, const uint8_t *rgba); // width * height * 4 bytes, sRGB; ignores alpha
void video_set_comment(video *v, const char *text);
bool video_finish(video *v);  // completes the file and frees `v`
void video_abandon(video *v); // frees `v` and leaves no file; NULL is allowed
