// Where things of an effect are in space, and which controls move them: for windows that draw
// handles over a picture and let hands drag them. Part of roil.h, which includes it; its rules on
// errors, threads and memory hold here too.
//
// Call all of this between frames. Points are in the world (m), at the time of the last frame, or
// the first where there was none.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef enum roil_thing {
    ROIL_CAMERA, // the script's own, wherever settings have put it
    ROIL_SUN,
    ROIL_LIGHT,
    ROIL_SHAPE,     // a field such as sphere { }: what fills space, or where a source is
    ROIL_PARTICLES, // where they are born
    ROIL_MESH,
    ROIL_NODE,
    ROIL_VOLUME, // the box of a simulation or of a sequence of files
    ROIL_THINGS
} roil_thing;
extern const char *const roil_things[ROIL_THINGS]; // names: "camera"

typedef struct roil_handle { // a point of a thing; strings live as long as the effect
    roil_thing thing;
    const char *name; // of the thing: "lamp"
    const char *part; // what of it the point is: "position", "target", "radius", "size", "key"
    // Of the sun the direction towards it, of length 1; of a mesh that a control moves the middle
    // of its box.
    float at[3];
    const char *control;   // that moves the point; NULL: only the script does
    const char *second;    // the other one of two: "sun.elevation" beside "sun.azimuth"; NULL: none
    size_t key;            // of the curve that the control is, from 0
    bool structural;       // moving it loads the effect anew (roil_live does)
    bool along;            // it moves along one line only, as a radius does
    float line[3];         // the direction of that line
    bool moves;            // over time: roil_handle_path says where to
    float radius;          // of the thing, around the point; 0: none
    float low[3], high[3]; // box around the thing; equal: none
} roil_handle;

// Lists the points of all things that have a place: those of one thing in succession.
size_t roil_handles(roil_effect *e, roil_handle *out, size_t capacity);
// Returns what the control of a handle (its index in the list; `second`: the other control) is to
// be set to for its point to come to `at`, as near as its range allows. Free it with roil_free.
// NULL with a message: it has no control, or there is no such handle.
char *roil_handle_text(roil_effect *e, size_t handle, bool second, const float at[3]);
// Finds where the point of a handle is at `count` times (s). False with a message when the script
// fails there.
bool roil_handle_path(roil_effect *e, size_t handle, const double *times, float (*out)[3],
                      size_t count);

// ---- what fills space ---------------------------------------------------------------------------

enum { ROIL_PROBE_VALUES = 8 };
typedef struct roil_probed {
    bool found;    // false: nothing is seen there
    float at[3];   // the point that half of what one sees lies before (m)
    float density; // of all media together (1/m)
    struct {
        const char
            *name; // what the script reads of a grid: "air.temperature"; as long as the effect
        int components;
        float value[4];
    } values[ROIL_PROBE_VALUES];
    size_t count; // of them
} roil_probed;
// Finds what one sees of the effect's media along the camera's ray through x, y (0 to 1 from the
// top left), in the last frame. Waits for the device; the first call of an effect compiles a
// shader. False with a message: the effect has no medium, or one that fills all of space.
bool roil_probe(roil_effect *e, float x, float y, roil_probed *out);

#ifdef __cplusplus
}
#endif
