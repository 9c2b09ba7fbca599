#include "ui/input.h"
#include <GLFW/glfw3.h>
#include <float.h>

// ---- queue ------------------------------------------------------------------------------------

static input_event *queue_last(input_queue *q) {
    return q->count ? &q->events[(q->first + q->count - 1) % INPUT_EVENTS] : NULL;
}

void input_push(input_queue *q, const input_event *e) {
    input_event *before = queue_last(q);
    if (before && before->kind == e->kind && e->kind == INPUT_MOVE) {
        *before = *e;
    } else if (before && before->kind == e->kind && e->kind == INPUT_WHEEL) {
        before->x += e->x;
        before->y += e->y;
    } else {
        if (q->count == INPUT_EVENTS) {
            q->first = (q->first + 1) % INPUT_EVENTS;
            q->count--;
        }
        q->events[(q->first + q->count++) % INPUT_EVENTS] = *e;
    }
}

bool input_acts(const input_queue *q) {
    for (size_t i = 0; i < q->count; i++)
        if (q->events[(q->first + i) % INPUT_EVENTS].kind != INPUT_MOVE) return true;
    return false;
}

static uint64_t *word_of(input_frame *frame, const input_event *e, uint64_t *bit) {
    unsigned key = (unsigned)e->code % INPUT_KEYS;
    *bit = UINT64_C(1) << key % 64;
    return &frame->keys[key / 64];
}

// After a click the pointer stays where it is for the rest of the frame, and nothing else happens,
// since what follows may depend on what the click did. A dragged item first moves to where it is
// released.
static bool fits(input_frame *frame, const input_event *e) {
    uint64_t bit;
    if (frame->clicked) return false;
    switch (e->kind) {
    case INPUT_MOVE:
    case INPUT_WHEEL:
        return !frame->wheeled;
    case INPUT_BUTTON:
        return !frame->wheeled && !(frame->moved && e->action == GLFW_RELEASE);
    case INPUT_KEY:
        return !(*word_of(frame, e, &bit) & bit);
    case INPUT_CHAR:
        break;
    }
    return true;
}

static void frame_note(input_frame *frame, const input_event *e) {
    uint64_t bit;
    if (e->kind == INPUT_MOVE) frame->moved = true;
    if (e->kind == INPUT_WHEEL) frame->wheeled = true;
    if (e->kind == INPUT_BUTTON) frame->clicked = true;
    if (e->kind == INPUT_KEY) *word_of(frame, e, &bit) |= bit;
}

bool input_take(input_queue *q, input_frame *frame, input_event *out) {
    if (!q->count || !fits(frame, &q->events[q->first])) return false;
    *out = q->events[q->first];
    q->first = (q->first + 1) % INPUT_EVENTS;
    q->count--;
    frame_note(frame, out);
    return true;
}

// ---- window -----------------------------------------------------------------------------------

static input_queue *heard; // GLFW's own pointer for callbacks is the window's owner's

static void on_move(GLFWwindow *window, double x, double y) {
    (void)window;
    input_push(heard, &(input_event){.kind = INPUT_MOVE, .x = x, .y = y});
}

static void on_enter(GLFWwindow *window, int entered) {
    bool held = false; // then moves beyond the border still come
    for (int i = 0; i <= GLFW_MOUSE_BUTTON_LAST; i++)
        held = held || glfwGetMouseButton(window, i) == GLFW_PRESS;
    if (!entered && !held) on_move(window, -FLT_MAX, -FLT_MAX);
}

static void on_button(GLFWwindow *window, int button, int action, int mods) {
    (void)window;
    input_push(heard, &(input_event){
                          .kind = INPUT_BUTTON, .code = button, .action = action, .mods = mods});
}

static void on_wheel(GLFWwindow *window, double x, double y) {
    (void)window;
    input_push(heard, &(input_event){.kind = INPUT_WHEEL, .x = x, .y = y});
}

static void on_key(GLFWwindow *window, int key, int scan, int action, int mods) {
    (void)window;
    input_push(heard,
               &(input_event){
                   .kind = INPUT_KEY, .code = key, .scan = scan, .action = action, .mods = mods});
}

static void on_char(GLFWwindow *window, unsigned code) {
    (void)window;
    input_push(heard, &(input_event){.kind = INPUT_CHAR, .code = (int)code});
}

void input_listen(GLFWwindow *window, input_queue *q) {
    heard = q;
    glfwSetCursorPosCallback(window, on_move);
    glfwSetCursorEnterCallback(window, on_enter);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetScrollCallback(window, on_wheel);
    glfwSetKeyCallback(window, on_key);
    glfwSetCharCallback(window, on_char);
}
