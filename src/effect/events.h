// Events of an effect: keys and clicks at a time, from its own list, the user or the command line;
// and its systems, functions of the script that run from frame to frame and handle events.
//
// Systems run once for every frame of the timeline, also for those that are not drawn: first the
// functions of each frame, then the handlers of events since the frame before. When time goes back,
// they start again from the first frame, with the parameters that they set reset. A frame therefore
// depends only on the events before it, and not on which frames were drawn.
#pragma once
#include "effect/effect.h"
#include "scene/bvh.h"

enum { EFFECT_MOST_EVENTS = 4096, EFFECT_KEY_SIZE = 16, EFFECT_MOST_STATUS = 32 };

typedef struct effect_event {
    double time;               // seconds
    char key[EFFECT_KEY_SIZE]; // "f", "enter"; "": a click
    // How the place is given: 0: none; 2: a position in the picture, 0 to 1 from its top left; 3: a
    // point (m); 6: a ray, its origin and direction.
    int numbers;
    float at[6];
} effect_event;

typedef struct effect_happening { // an event as the script gets it
    const effect_event *event;
    bool placed;                   // it has a place:
    float x, y;                    // position in the picture, 0 to 1 from its top left
    float origin[3], direction[3]; // the camera's ray there; the direction has length 1
    bool met;                      // the ray hits something:
    scene_hit hit;                 // mesh NULL: the ground, z = 0
} effect_happening;

// Parses "2.5 click 0.4 0.6; 3 key f; 4 key f 12 -3 0": seconds, event and place. `out` must have
// room for EFFECT_MOST_EVENTS. False with a message.
bool events_parse(const char *text, effect_event *out, size_t *count);
void events_print(const effect_event *list, size_t count, strbuf *out);
// Checks whether an event is valid. False with a message.
bool events_check(const effect_event *event);

// ---- declaring (script) -----------------------------------------------------------------------

// Declares that the script handles a key ("": clicks). `help` says what it does ("": no help).
bool effect_add_hearing(effect *e, const char *key, const char *help);
void effect_add_systems(effect *e); // it has functions of frames, or of the start
bool effect_set_events(effect *e, const effect_event *list, size_t count); // its own events
// Sets a parameter until time goes back.
bool effect_move_param(effect *e, size_t param, const float value[4]);
// Sets a value that is shown to users while the effect runs. `unit` "bool": 1 means yes.
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
// Finds what a ray hits in the frame that was evaluated last: a mesh that is drawn, or where there
// is none, the ground z = 0. The direction may have any length but 0. False: nothing.
bool effect_pick(effect *e, const float origin[3], const float direction[3], scene_hit *out);
// Returns whether a point (m) lies under the ground: below the back of a mesh that is no instance,
// and not inside of that mesh. `height` receives the height of the ground above the point (m).
bool effect_is_under_ground(effect *e, const float at[3], float *height);
// Returns the camera's ray through a position in the picture, for the same frame.
bool effect_camera_ray(effect *e, float x, float y, float origin[3], float direction[3]);
// Returns the time at which the systems ran last (s); -INFINITY: never. Events at that time are
// handled before the next frame is drawn, even if it is the same frame.
double effect_systems_time(const effect *e);
const effect_event *effect_events(const effect *e, size_t *count); // valid events, by time
