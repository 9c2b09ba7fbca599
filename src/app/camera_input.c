// Lets the user move the camera: dragging and the wheel over the picture set the controls
// camera.eye and camera.target, which survive a reload like any other control.
#include "app/branches.h"
#include <math.h>
#include <stdio.h>

static const float TURN = 0.3f;   // degrees a unit
static const float ABOVE = 0.01f; // of the ground, by the distance of what is looked at
static const float STEEP = 89;    // degrees
enum { RAISES = 4 };              // at most: ground that slopes is another where the eye then is

// Starts from the camera that the user moved last; after a reload or a reset, from the one that the
// effect was drawn with.
static bool take_up(live *l) {
    roil_camera camera;
    if (l->camera_moved) return true;
    if (!l->effect || !roil_get_camera(l->effect, &camera)) return false;
    orbit_from(&l->camera, &camera);
    return true;
}

static void set_point(live *l, const char *name, const float p[3]) {
    char text[128];
    snprintf(text, sizeof text, "%.6g,%.6g,%.6g", (double)p[0], (double)p[1], (double)p[2]);
    live_set(l, name, text);
}

static void set_number(live *l, const char *name, float value) {
    char text[32];
    snprintf(text, sizeof text, "%.6g", (double)value);
    live_set(l, name, text);
}

static void put_down(live *l) {
    roil_camera camera;
    orbit_to(&l->camera, &camera);
    set_point(l, "camera.eye", camera.eye);
    set_point(l, "camera.target", camera.target);
    if (camera.orthographic > 0) set_number(l, "camera.orthographic", camera.orthographic);
    l->camera_moved = true;
    branches_forget(l);
}

static float aspect_of(const live *l) {
    return (l->view.right - l->view.left) / fmaxf(l->view.bottom - l->view.top, 1);
}

static bool is_under_ground(const live *l, const orbit *o, float *height) {
    roil_camera camera;
    orbit_to(o, &camera);
    return roil_is_under_ground(l->effect, camera.eye, height);
}

// After a move from `before`: a camera that stood above the ground is kept above it.
static void stay_above_ground(live *l, const orbit *before, bool shift) {
    float height;
    if (is_under_ground(l, before, &height)) return;
    for (int i = 0; i < RAISES && is_under_ground(l, &l->camera, &height); i++)
        orbit_raise(&l->camera, height + ABOVE * l->camera.distance, shift);
    if (is_under_ground(l, &l->camera, &height)) l->camera = *before;
}

void camera_input(live *l, const ui_canvas *view) {
    bool moved = (view->held || view->middle_held) && (view->dx != 0 || view->dy != 0);
    if (view->pressed) moved = false; // that was the way to where it was pressed
    if (view->double_clicked && !event_hears_clicks(l)) camera_frame(l);
    if ((!moved && view->wheel == 0) || !take_up(l)) return;
    float height = fmaxf(view->area.bottom - view->area.top, 1);
    const orbit before = l->camera;
    const bool pans = moved && (view->middle_held || view->shift);
    if (view->wheel != 0) orbit_zoom(&l->camera, view->wheel);
    if (pans)
        orbit_pan(&l->camera, view->dx / height, view->dy / height);
    else if (moved)
        orbit_turn(&l->camera, -view->dx * TURN / ui_scale(), view->dy * TURN / ui_scale());
    stay_above_ground(l, &before, pans);
    put_down(l);
}

void camera_frame(live *l) {
    float low[3], high[3];
    if (!take_up(l)) return;
    if (!roil_get_bounds(l->effect, low, high)) {
        live_notice(l, "The effect has no volume of finite size to frame.");
        return;
    }
    orbit_frame(&l->camera, low, high, aspect_of(l));
    put_down(l);
}

void camera_reset(live *l) {
    if (!l->effect) return;
    live_reset(l, "camera.eye");
    live_reset(l, "camera.target");
    live_reset(l, "camera.orthographic");
    branches_forget(l);
    l->camera_moved = false;
}

// ---- without perspective ------------------------------------------------------------------------

static void look_along(live *l, float yaw, float pitch) {
    if (!take_up(l)) return;
    orbit_flatten(&l->camera);
    l->camera.yaw = yaw;
    l->camera.pitch = pitch;
    put_down(l);
}

void camera_front(live *l) {
    look_along(l, 0, 0);
}

void camera_side(live *l) {
    look_along(l, 90, 0);
}

void camera_top(live *l) {
    look_along(l, 0, 90);
}

void camera_perspective(live *l) {
    if (!take_up(l) || l->camera.orthographic == 0) return;
    orbit_deepen(&l->camera);
    l->camera.pitch = fminf(l->camera.pitch, STEEP);
    live_set(l, "camera.orthographic", "0");
    put_down(l);
}
