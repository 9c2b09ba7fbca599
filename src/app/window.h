// A window of the desktop, through GLFW. Sizes and positions are kept in the session.
#pragma once
#include "app/live.h"

struct window {
    GLFWwindow *handle;
    roil_window_desc desc; // for roil_create
    int held[4];           // x, y, width, height while it was not maximised
    char title[256];
    bool busy; // the title says so
};

// `width` 0: as the session says, else a size that suits the display. False with a message when
// there is no display.
bool window_open(window *w, const live_session *s, const char *title, int width, int height);
void window_close(window *w);
void window_keep(window *w, live_session *s);                           // its place
void window_pixels(const window *w, uint32_t *width, uint32_t *height); // 0 while minimised
float window_scale(const window *w); // pixels of a unit: 1, or more on a display of high density
bool window_closing(window *w);      // also ends what window_wait_busy showed
// Takes what has come, or waits for it at most so many seconds. True when something came.
bool window_wait(double seconds);
typedef enum window_busy { WINDOW_GOES_ON, WINDOW_GIVES_UP, WINDOW_QUIT } window_busy;
// While a frame is under way: takes what has come, and shows how long it has been. WINDOW_GIVES_UP:
// the user pressed Escape.
window_busy window_wait_busy(window *w, double seconds);
void window_wake(void *unused); // from any thread: ends the wait
