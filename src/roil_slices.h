// Flows in slices, shown and changed while they run: views of their fields, pushes, and templates
// taken out of a flow and put into one. Part of roil.h, which includes it; its rules on errors,
// threads and memory hold here too. What changes a flow needs a roil made with
// roil_desc.interaction.
//
// Call all of this between frames. Positions in a slice are as in an effect's file: x goes from 0
// at the left edge to 1 at the right one, y from 0 at the lower edge upwards. Sizes have the same
// unit, which is the width of the slice.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_slices { // a pass `slices`; strings live as long as the effect
    const char *name;        // variable of the script
    const char *pass;        // label of the pass
    uint32_t count, size[2]; // number of slices, and cells of each
    float width, height;     // of a slice (m)
    double time_step;        // seconds
} roil_slices;
size_t roil_slices_list(const roil_effect *e, roil_slices *out, size_t capacity);

// ---- views ------------------------------------------------------------------------------------

typedef enum roil_slices_field {
    ROIL_SLICES_DENSITY,
    ROIL_SLICES_TEMPERATURE,
    ROIL_SLICES_DYE,
    ROIL_SLICES_PRESSURE, // m^2/s^2: green above zero, red below
    ROIL_SLICES_VELOCITY, // m/s: red right, yellow-green up, cyan left, violet down; with arrows
    ROIL_SLICES_FIELDS
} roil_slices_field;
extern const char *const roil_slices_fields[ROIL_SLICES_FIELDS]; // names: "density"

typedef struct roil_slices_view {
    size_t flow;    // index in roil_slices_list
    uint32_t slice; // from 0
    roil_slices_field field;
    float range;  // value (its size) that is drawn brightest, above 0
    float arrows; // pixels between two arrows; 0: none
} roil_slices_view;
// Draws the state of the slice after its last step over the whole texture. Returns false with a
// message also when there was no step yet.
bool roil_slices_draw(roil_effect *e, const roil_slices_view *how, roil_texture *target);
// Returns in `out` the greatest size of the field's values in the slice. Waits for the device.
bool roil_slices_greatest(roil_effect *e, const roil_slices_view *how, float *out);

// ---- changes ----------------------------------------------------------------------------------

typedef struct roil_slices_square { // an upright square in a slice
    size_t flow;                    // index in roil_slices_list
    uint32_t slice;                 // from 0
    float middle[2], side;
} roil_slices_square;

// Applies a force (m/s^2) in the square for the next step, strongest at its middle and fading
// towards its border.
bool roil_slices_push(roil_effect *e, const roil_slices_square *where, const float force[2]);

// Writes the flow in the square as a template, "templates/NAME.exr" in the effect's folder. An
// existing file is never replaced. Velocity and pressure are each scaled to -1 to 1; `scale`
// receives what 1 stands for, in m/s and m^2/s^2. Waits for the device.
bool roil_slices_capture(roil_effect *e, const roil_slices_square *where, const char *name,
                         float scale[2]);

// ---- templates --------------------------------------------------------------------------------

typedef struct roil_template { // a picture in templates/ of the effect's folder or of the library
    char file[64];             // "source.exr"
    bool library;              // it is the library's; the effect's folder has none of that name
    int64_t changed;           // differs when the file was changed
} roil_template;
// Lists the templates, sorted by name.
size_t roil_templates(const roil_effect *e, roil_template *out, size_t capacity);
// Draws a picture of a template in the colours of the views, side * side * 4 bytes, for people to
// recognise it. Returns false with a message also for a picture that is not square, which is no
// template.
bool roil_template_icon(roil_effect *e, const char *file, bool velocity, uint32_t side,
                        uint8_t *out);

typedef struct roil_template_use { // a template in a flow
    roil_slices_square where;
    bool everywhere;  // in all slices
    const char *file; // roil_template.file
    bool velocity;    // apply its velocity as a force; else its pressure
    float angle;      // degrees, anticlockwise
    float strength;   // m/s^2, or m^2/s^2 for pressure
    float blend;      // of pressure, 0 to 1: how firmly it is held, as the uniform of that name
    double lifetime;  // seconds of the simulation; 0: one step
} roil_template_use;
// Puts a template into a flow, from the next step on. At most eight can be there at a time: the one
// that would end first makes room for a new one.
bool roil_template_put(roil_effect *e, const roil_template_use *use);
// Returns the line of Lua that has the same effect all the time, for the effect's file. Free it
// with roil_free. A template of the library is copied into the effect's folder, since the effect's
// file can read nothing else.
char *roil_template_lua(roil_effect *e, const roil_template_use *use);

#ifdef __cplusplus
}
#endif
