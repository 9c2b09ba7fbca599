// MP4 (H.264 where the encoder exists, else MPEG-4 part 2), written frame by frame.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct video video;

// Odd sizes are padded by one row or column. The file appears under its name only on success.
video *video_create(const char *path, uint32_t width, uint32_t height, double fps);
bool video_add(video *v, const uint8_t *rgba); // width * height * 4, sRGB; alpha is ignored
bool video_finish(video *v);                   // flushes, renames, destroys
void video_abandon(video *v);                  // destroys, leaves no file; NULL is fine
