#define GLFW_INCLUDE_VULKAN // of glfwCreateWindowSurface; Vulkan itself is not used here
#include "app/window.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "base/str.h"
#include <GLFW/glfw3.h>
#include <stdio.h>

static const float SHARE = 0.85f; // of the display, at first
enum { WIDTH = 1440, HEIGHT = 900, MIN_SEEN = 80 };

static void on_error(int code, const char *text) {
    log_write(LOG_DEBUG, "live: GLFW %#x: %s", (unsigned)code, text);
}

static bool create_surface(void *user, void *instance, void *surface) {
    const window *w = user;
    if (glfwCreateWindowSurface((VkInstance)instance, w->handle, NULL, (VkSurfaceKHR *)surface) ==
        VK_SUCCESS)
        return true;
    const char *why = NULL;
    glfwGetError(&why);
    return err_set("the window has no surface for Vulkan: %s", why ? why : "unknown reason");
}

static bool glfw_start(void) {
    glfwSetErrorCallback(on_error);
    if (glfwInit()) return true;
    const char *why = NULL;
    glfwGetError(&why);
    return err_set("there is no display (%s); `roil render` needs none", why ? why : "GLFW failed");
}

// A stored position may be on a display that no longer exists.
static bool is_seen(const live_session *s) {
    int count;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; i++) {
        int x, y, width, height;
        glfwGetMonitorWorkarea(monitors[i], &x, &y, &width, &height);
        if (s->x + s->width > x + MIN_SEEN && s->x < x + width - MIN_SEEN && s->y >= y &&
            s->y < y + height - MIN_SEEN)
            return true;
    }
    return false;
}

// A stored size that exceeds the display is reduced.
static void fit_session(const live_session *s, int *width, int *height) {
    int x, y, most_width = 0, most_height = 0;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    if (monitor) glfwGetMonitorWorkarea(monitor, &x, &y, &most_width, &most_height);
    *width = s->width < most_width || !most_width ? s->width : most_width;
    *height = s->height < most_height || !most_height ? s->height : most_height;
}

static int smaller(int a, float b) {
    return (float)a < b ? a : (int)b;
}

static void first_size(int *width, int *height) {
    int x, y, most_width = WIDTH, most_height = HEIGHT;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    *width = WIDTH;
    *height = HEIGHT;
    if (!monitor) return;
    glfwGetMonitorWorkarea(monitor, &x, &y, &most_width, &most_height);
    *width = smaller(WIDTH, SHARE * (float)most_width);
    *height = smaller(HEIGHT, SHARE * (float)most_height);
}

static void on_drop(GLFWwindow *handle, int count, const char **paths) {
    const window *w = glfwGetWindowUserPointer(handle);
    if (w->drop && count > 0) w->drop(w->drop_user, paths[0]);
}

void window_on_drop(window *w, void (*drop)(void *user, const char *path), void *user) {
    w->drop = drop;
    w->drop_user = user;
    glfwSetWindowUserPointer(w->handle, w);
    glfwSetDropCallback(w->handle, drop ? on_drop : NULL);
}

bool window_open(window *w, const live_session *s, const char *title, int width, int height) {
    *w = (window){.handle = NULL};
    if (!glfw_start()) return false;
    bool placed = !width && s->width > 0;
    if (placed) {
        fit_session(s, &width, &height);
    } else if (!width) {
        first_size(&width, &height);
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_MAXIMIZED, placed && s->maximized);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE); // until it has its place
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "roil");
    w->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    if (!w->handle) {
        const char *why = NULL;
        glfwGetError(&why);
        err_set("the window cannot be made: %s", why ? why : "GLFW failed");
        glfwTerminate();
        return false;
    }
    if (placed && is_seen(s)) glfwSetWindowPos(w->handle, s->x, s->y);
    glfwShowWindow(w->handle);
    w->held[2] = width;
    w->held[3] = height;
    str_copy(w->title, sizeof w->title, title);
    w->desc.extensions = glfwGetRequiredInstanceExtensions(&w->desc.extension_count);
    w->desc.create_surface = create_surface;
    w->desc.user = w;
    if (w->desc.extensions) return true;
    window_close(w);
    return err_set("Vulkan cannot show anything on this display");
}

void window_close(window *w) {
    if (!w->handle) return;
    glfwDestroyWindow(w->handle);
    glfwTerminate();
    w->handle = NULL;
}

void window_keep(window *w, live_session *s) {
    s->maximized = glfwGetWindowAttrib(w->handle, GLFW_MAXIMIZED);
    if (!s->maximized && !glfwGetWindowAttrib(w->handle, GLFW_ICONIFIED)) {
        glfwGetWindowPos(w->handle, &w->held[0], &w->held[1]); // stays 0 on Wayland
        glfwGetWindowSize(w->handle, &w->held[2], &w->held[3]);
    }
    s->x = w->held[0];
    s->y = w->held[1];
    s->width = w->held[2];
    s->height = w->held[3];
}

void window_pixels(const window *w, uint32_t *width, uint32_t *height) {
    int x = 0, y = 0;
    glfwGetFramebufferSize(w->handle, &x, &y);
    bool hidden = glfwGetWindowAttrib(w->handle, GLFW_ICONIFIED) || x <= 0 || y <= 0;
    *width = hidden ? 0 : (uint32_t)x;
    *height = hidden ? 0 : (uint32_t)y;
}

float window_scale(const window *w) {
    float x = 1, y = 1;
    glfwGetWindowContentScale(w->handle, &x, &y);
    return x < 0.5f ? 0.5f : x > 4 ? 4 : x;
}

bool window_closing(const window *w) {
    return glfwWindowShouldClose(w->handle);
}

void window_tell_busy(window *w, double seconds) {
    int whole = (int)seconds;
    if (whole == w->busy) return;
    char title[sizeof w->title + 64];
    snprintf(title, sizeof title, "%s \u2013 busy for %d s (Escape stops)", w->title, whole);
    glfwSetWindowTitle(w->handle, whole ? title : w->title);
    glfwSetInputMode(w->handle, GLFW_STICKY_KEYS, GLFW_FALSE);
    w->busy = whole;
}

bool window_wait(double seconds) {
    if (!(seconds > 0)) {
        glfwPollEvents();
        return true;
    }
    double end = clock_seconds() + seconds;
    glfwWaitEventsTimeout(seconds);
    return clock_seconds() < end - 1e-3;
}

static bool is_pressed(const window *w, int key) {
    return glfwGetKey(w->handle, key) == GLFW_PRESS;
}

window_busy window_wait_busy(window *w, double seconds) {
    window_tell_busy(w, seconds);
    glfwSetInputMode(w->handle, GLFW_STICKY_KEYS, GLFW_TRUE); // a short press is seen, too
    glfwPollEvents();
    bool control = is_pressed(w, GLFW_KEY_LEFT_CONTROL) || is_pressed(w, GLFW_KEY_RIGHT_CONTROL);
    if (glfwWindowShouldClose(w->handle) || (is_pressed(w, GLFW_KEY_Q) && control))
        return WINDOW_QUIT;
    return is_pressed(w, GLFW_KEY_ESCAPE) ? WINDOW_GIVES_UP : WINDOW_GOES_ON;
}

void window_wake(void *unused) {
    (void)unused;
    glfwPostEmptyEvent();
}
