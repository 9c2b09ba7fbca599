// Writes films frame by frame: .mp4 (H.264 where the encoder exists, else MPEG-4 part 2), .webm
// (VP9), .mov (ProRes 4444), .gif and .apng.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct video video;

bool video_is_film(const char *path); // its extension is one of these
// Begins a file, of the kind that its extension says. Odd sizes are padded by one row or column
// where colours have half the size. With `alpha` pictures keep theirs, straight; not in an .mp4.
// The file appears under its name only when it is finished. NULL with a message.
video *video_create(const char *path, uint32_t width, uint32_t height, double fps, bool alpha);
bool video_add(video *v, const uint8_t *rgba); // width * height * 4 bytes, sRGB
// What the file says of itself, as it is: a line of text without bytes above 126. Once.
void video_set_comment(video *v, const char *text);
bool video_finish(video *v);  // completes the file and frees `v`
void video_abandon(video *v); // frees `v` and leaves no file; NULL is allowed
