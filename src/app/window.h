// A window of the desktop, through GLFW. The session stores its size and position.
#pragma once
#include "app/live.h"

struct window {
    GLFWwindow *handle;
    roil_window_desc desc; // for roil_create
    int held[4];           // x, y, width, height when it was not maximised
    char title[256];
    int busy; // seconds that the title says; 0: none
    void (*drop)(void *user, const char *path);
    void *drop_user;
};

// Opens a window. `width` 0: the session's size, or one that suits the display. False with a
// message when there is no display.
bool window_open(window *w, const live_session *s, const char *title, int width, int height);
void window_close(window *w);
void window_keep(window *w, live_session *s); // stores its size and position
void window_pixels(const window *w, uint32_t *width, uint32_t *height); // 0 while minimised
float window_scale(const window *w); // pixels per unit: 1, or more on a display of high density
bool window_closing(const window *w);
void window_tell_busy(window *w, double seconds); // in the title; less than 1: it is not
// Handles events, or waits for one at most `seconds`. True when there was one.
bool window_wait(double seconds);
typedef enum window_busy { WINDOW_GOES_ON, WINDOW_GIVES_UP, WINDOW_QUIT } window_busy;
// Handles events while the device works on a frame, and shows the seconds that it has taken.
// WINDOW_GIVES_UP: the user pressed Escape.
window_busy window_wait_busy(window *w, double seconds);
// Sets a callback for each file that is dropped on the window, or removes it (NULL).
void window_on_drop(window *w, void (*drop)(void *user, const char *path), void *user);
void window_wake(void *unused); // ends window_wait; any thread
