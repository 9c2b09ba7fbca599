// Recipes: how a picture was made, stored in the texts of its PNG file. It may come from a
// stranger.
#pragma once
#include "effect/effect.h"
#include "media/png.h"

typedef struct recipe {
    const char *file; // the effect's file as it was given; NULL: it lies outside of the current
                      // folder and must not be opened unless the user names it
    double frame;
    uint32_t width, height;
    effect_setting *settings; // every control that differs from the script
    size_t setting_count;
} recipe;

enum { RECIPE_TEXTS = 5, RECIPE_MAX_SETTINGS = 4096 };
void recipe_write(const effect *e, double frame, uint32_t width, uint32_t height, arena *memory,
                  png_text out[RECIPE_TEXTS]);
bool recipe_read(const png_text *texts, size_t count, arena *memory, recipe *out);

bool recipe_is_plain(const char *text);    // one line, without what terminals obey
bool recipe_is_effect(const char *text);   // can be the file of an effect, or a bundle
bool recipe_stays_below(const char *path); // as text: it does not leave the current folder
bool recipe_is_name(const char *text);     // can be that of a control
