// Palette: a transfer function from a number to colour and alpha, which may itself move in time.
#pragma once
#include "base/arena.h"
#include "base/str.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PALETTE_SIZE = 512, PALETTE_MAX_STOPS = 64, PALETTE_MAX_KEYS = 64 };

typedef enum palette_space { PALETTE_LINEAR, PALETTE_OKLAB } palette_space; // where stops are mixed

typedef struct palette_stop {
    float at;       // position, in the palette's range
    float color[4]; // linear Rec.709, any brightness; alpha
} palette_stop;

typedef struct palette_key {   // one state of a palette that is keyed over time
    float time;                // seconds
    const palette_stop *stops; // at least two, rising; equal positions make a hard edge
    size_t count;
} palette_key;

typedef struct palette_desc {
    palette_space space;
    float min, max;          // value range that the texture covers; both 0: the range of the stops
    const palette_key *keys; // between keys, baked colours are mixed linearly
    size_t key_count;
    // Or, with key_count 0, blackbody radiation: positions are kelvin, from min to max. Colour of
    // Planck's law (CIE 1931), times the radiance relative to `reference` kelvin to the power 4 if
    // `physical`, else of luminance 1.
    bool blackbody;
    bool physical;
    float reference; // kelvin; 0: 1500
} palette_desc;

typedef struct palette palette;
// Checks and copies. False message names the stop or key at fault.
palette *palette_create(arena *memory, const palette_desc *desc);
// Makes it another one: fields keep pointing to it. Memory is taken once at most: there may be as
// many stops as it had when it was made, or PALETTE_MAX_STOPS. False leaves it as it was. `desc`
// must not point into what an earlier palette_replace made.
bool palette_replace(palette *p, const palette_desc *desc);
const palette_desc *palette_get_desc(const palette *p); // as it was given, in linear colours
uint32_t palette_version(const palette *p);             // counts replacements
// "0 #000000; 0.5 #7a1500 0.5; 1 4,2,0.5": position, colour as sRGB or three linear numbers, alpha.
// Checks the form; palette_replace checks the values.
bool palette_parse(const char *text, palette_stop out[PALETTE_MAX_STOPS], size_t *count);
void palette_print(const palette_stop *stops, size_t count, strbuf *out);
void palette_range(const palette *p, float *min, float *max);
bool palette_is_animated(const palette *p);
// PALETTE_SIZE half-float RGBA texels for a time; texel i stands for position (i + 0.5) / size.
void palette_bake(const palette *p, double time, uint16_t out[PALETTE_SIZE * 4]);
void palette_eval(const palette *p, double time, float at, float out[4]); // as the texture gives it

// Linear Rec.709 colour of a black body of luminance 1, 500..20000 K (clamped).
void palette_blackbody(float kelvin, float out[3]);
