// What happens to an effect at a time: keys and clicks, by its own list, by hand or by the command
// line; and its systems, the functions of the script that go on from frame to frame by it.
//
// Systems run at every frame of the timeline once, also at those that are not drawn: first those of
// each frame, then what happened since the frame before. What they make of it is the script's. When
// time goes back, they begin anew from the first frame, and so do parameters that they set; so a
// frame follows from the events before it alone, whichever frames were drawn.
#pragma once
#include "effect/effect.h"
#include "scene/bvh.h"

enum { EFFECT_MOST_EVENTS = 4096, EFFECT_KEY_SIZE = 16, EFFECT_MOST_STATUS = 32 };

typedef struct effect_event {
    double time;               // seconds
    char key[EFFECT_KEY_SIZE]; // "f", "enter"; "": a click
    // Where the pointer is: 0: nowhere; 2: in the picture, 0..1 from its top left; 3: over a point
    // (m); 6: by a ray, from a point into a direction.
    int numbers;
    float at[6];
} effect_event;

typedef struct effect_happening { // an event as it reaches the script
    const effect_event *event;
    bool placed;                   // somewhere:
    float x, y;                    // in the picture, 0..1 from its top left
    float origin[3], direction[3]; // of the ray from the camera there; of length 1
    bool met;
    scene_hit hit; // mesh NULL: the ground, z = 0
} effect_happening;

// "2.5 click 0.4 0.6; 3 key f; 4 key f 12 -3 0": seconds, what, and where. At most
// EFFECT_MOST_EVENTS; `out` has room for as many. False with a message.
bool events_parse(const char *text, effect_event *out, size_t *count);
void events_print(const effect_event *list, size_t count, strbuf *out);
// Why it cannot happen, as a message; true when it can.
bool events_check(const effect_event *event);

// ---- declaring (script) -----------------------------------------------------------------------

// The effect hears a key, "" clicks; `help` says what it does then ("": nothing is said).
bool effect_add_hearing(effect *e, const char *key, const char *help);
void effect_add_systems(effect *e); // it has functions of frames, or of the start
bool effect_set_events(effect *e, const effect_event *list, size_t count); // its own
// Sets a parameter until time goes back.
bool effect_move_param(effect *e, size_t param, const float value[4]);
// A number that is shown to users while it runs.
// `unit`: "bool": 1 is yes.
bool effect_set_status(effect *e, const char *name, double value, const char *unit);

// ---- asking -----------------------------------------------------------------------------------

typedef struct effect_hearing {
    const char *key, *help;
} effect_hearing;
size_t effect_hearings(const effect *e, const effect_hearing **out);
typedef struct effect_status {
    const char *name, *unit;
    double value;
} effect_status;
size_t effect_statuses(const effect *e, const effect_status **out);
// Along a ray, of any length but 0: meshes that are drawn; the ground, z = 0, where there is none.
// As of the frame that was evaluated last.
bool effect_pick(effect *e, const float origin[3], const float direction[3], scene_hit *out);
// Whether a point lies under the ground: a mesh, not one of instances, whose back is above it,
// while it is not inside of that. `height`: of the ground straight above it (m).
bool effect_is_under_ground(effect *e, const float at[3], float *height);
// The ray of the camera through a place in the picture, as of the same frame.
bool effect_camera_ray(effect *e, float x, float y, float origin[3], float direction[3]);
// When the systems ran last (s), -INFINITY: never. What is to happen at that time happens before
// the next frame is drawn, the same one too.
double effect_systems_time(const effect *e);
const effect_event *effect_events(const effect *e, size_t *count); // in force, by time
