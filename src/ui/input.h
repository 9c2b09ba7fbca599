// A queue of input events, so that a slow frame loses none. Each frame takes as many events as it
// can distinguish. The position of the pointer when a button went down is preserved, and a button
// or key that goes down and up between two frames is seen down for one frame.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum input_kind {
    INPUT_MOVE,   // to x, y
    INPUT_WHEEL,  // by x, y
    INPUT_BUTTON, // code: of GLFW; x, y: where
    INPUT_KEY,    // code, scan: of GLFW
    INPUT_CHAR,   // code: Unicode
} input_kind;

typedef struct input_event {
    input_kind kind;
    int code, scan, action, mods; // action: of GLFW
    double x, y;                  // screen coordinates
} input_event;

enum { INPUT_EVENTS = 256, INPUT_KEYS = 512 };

typedef struct input_queue {
    input_event events[INPUT_EVENTS]; // a ring
    size_t first, count;
} input_queue;

typedef struct input_frame { // events that a frame has taken; zero at its beginning
    bool moved, wheeled, clicked;
    uint64_t keys[INPUT_KEYS / 64]; // keys that changed
} input_frame;

typedef struct GLFWwindow GLFWwindow;
// Adds the window's events to the queue from now on. Only one window can be listened to.
void input_listen(GLFWwindow *window, input_queue *q);

// Adds an event. Successive moves are merged, and so are turns of the wheel. A full queue drops its
// oldest event.
void input_push(input_queue *q, const input_event *e);
bool input_acts(const input_queue *q); // an event is more than a move of the pointer
// Takes the next event for this frame. False: there is none, or it is for the next frame.
bool input_take(input_queue *q, input_frame *frame, input_event *out);
