// Flows in slices in a user's hands: seen, pushed, taken out of as templates, and given templates.
// Part of roil.h, which includes it. For what changes a flow its roil is made with `interaction`.
//
// Places in a slice are as in an effect's file: x from 0 at the left edge to 1, y from 0 at the
// lower edge on in the same unit, the slice's width; so are sizes. Between frames, all of it.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_slices { // a pass `slices`; strings live as long as the effect
    const char *name;        // variable of the script
    const char *pass;        // its label
    uint32_t count, size[2]; // slices, cells of each
    float width, height;     // of a slice, m
    double time_step;        // seconds
} roil_slices;
// Returns how many there are; at most `capacity` are written.
size_t roil_slices_list(const roil_effect *e, roil_slices *out, size_t capacity);

// ---- seeing -----------------------------------------------------------------------------------

typedef enum roil_slices_field {
    ROIL_SLICES_DENSITY,
    ROIL_SLICES_TEMPERATURE,
    ROIL_SLICES_DYE,
    ROIL_SLICES_PRESSURE, // m^2/s^2: green above zero, red below
    ROIL_SLICES_VELOCITY, // m/s: red right, yellow-green up, cyan left, violet down; and arrows
    ROIL_SLICES_FIELDS
} roil_slices_field;
extern const char *const roil_slices_fields[ROIL_SLICES_FIELDS]; // "density"

typedef struct roil_slices_view {
    size_t flow;    // of the list
    uint32_t slice; // from 0
    roil_slices_field field;
    float range;  // what is brightest
    float arrows; // pixels from one to the next; 0: none
} roil_slices_view;
// Draws the whole slice over the whole texture: its state after the last step. False, with a
// message, also before the first.
bool roil_slices_draw(roil_effect *e, const roil_slices_view *how, roil_texture *target);
// The greatest size of what is seen; waits for the device.
bool roil_slices_greatest(roil_effect *e, const roil_slices_view *how, float *out);

// ---- touching ---------------------------------------------------------------------------------

typedef struct roil_slices_square { // upright, of a slice
    size_t flow;
    uint32_t slice; // from 0
    float middle[2], side;
} roil_slices_square;

// Pushes what is in the middle of the square, less towards its border, in the next step.
bool roil_slices_push(roil_effect *e, const roil_slices_square *where,
                      const float force[2]); // m/s^2

// Writes what flows in the square as a template, "templates/NAME.exr" in the effect's folder, where
// no file is ever replaced. Both its velocity and its pressure reach from -1 to 1; `scale`: what 1
// stands for, m/s and m^2/s^2. Waits for the device.
bool roil_slices_capture(roil_effect *e, const roil_slices_square *where, const char *name,
                         float scale[2]);

// ---- templates --------------------------------------------------------------------------------

typedef struct roil_template { // a picture in templates/ of the effect's folder, or of the library
    char file[64];             // "source.exr"
    bool library;              // the effect's own folder has none of that name
    int64_t changed;           // another number: the file is another
} roil_template;
// Sorted by name; the count. At most `capacity` are written.
size_t roil_templates(const roil_effect *e, roil_template *out, size_t capacity);
// As a picture of side * side * 4 bytes for a person to know it by, in the colours of the views.
// False, with a message, also of what is no square: a sheet of icons, not a template.
bool roil_template_icon(roil_effect *e, const char *file, bool velocity, uint32_t side,
                        uint8_t *out);

typedef struct roil_template_use { // a template put into a flow
    roil_slices_square where;
    bool everywhere; // in all slices
    const char *file;
    bool velocity;   // its velocity, as a force; else its pressure
    float angle;     // degrees, anticlockwise
    float strength;  // m/s^2, or m^2/s^2
    float blend;     // of pressure, 0 to 1: how firmly it is held, as the uniform of that name
    double lifetime; // seconds of the simulation; 0: one step
} roil_template_use;
// From the next step on. Of more than eight at a time the one that would end first makes room.
bool roil_template_put(roil_effect *e, const roil_template_use *use);
// The line of the effect's file that puts it there all the time; free with roil_free. What is of
// the library alone is copied into the effect's folder, which is all that its file can read.
char *roil_template_lua(roil_effect *e, const roil_template_use *use);

#ifdef __cplusplus
}
#endif
