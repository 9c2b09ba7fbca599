// What keys and pointer did, in order, so that a slow frame loses none of it: each frame takes as
// much as it can tell apart. Where the pointer was when a button went down is kept, and a button or
// key that goes down and up between two frames is seen down for one.
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

typedef struct input_frame { // what a frame has taken; zero at its begin
    bool moved, wheeled, clicked;
    uint64_t keys[INPUT_KEYS / 64]; // that changed
} input_frame;

typedef struct GLFWwindow GLFWwindow;
// Puts into the queue what comes to the window from now on. One window can be listened to.
void input_listen(GLFWwindow *window, input_queue *q);

// Moves that follow each other become one, and so do turns of the wheel. A full queue forgets what
// is oldest.
void input_push(input_queue *q, const input_event *e);
// The next event that the frame may see. False: there is none, or it is for the next frame.
bool input_take(input_queue *q, input_frame *frame, input_event *out);
