// Recipe: what made a picture, kept in the texts of its PNG file. It may come from a stranger.
#pragma once
#include "effect/effect.h"
#include "media/png.h"

typedef struct recipe {
    const char *file; // of the effect, as it was given; NULL: not one to be opened unasked, for it
                      // lies outside of the current folder
    double frame;
    uint32_t width, height;
    effect_setting *settings; // all that differs from the script
    size_t setting_count;
} recipe;

enum { RECIPE_TEXTS = 5, RECIPE_MAX_SETTINGS = 4096 };
void recipe_write(const effect *e, double frame, uint32_t width, uint32_t height, arena *memory,
                  png_text out[RECIPE_TEXTS]);
bool recipe_read(const png_text *texts, size_t count, arena *memory, recipe *out);
