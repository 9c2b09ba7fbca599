// From the world to the picture in its view and back, as a camera sees it. Needs no window.
#pragma once
#include "roil.h"
#include "ui/ui.h"

typedef struct lens {
    float eye[3], right[3], up[3], forward[3]; // metres; the rest have length 1
    float half[2];                             // tangents of half the angles of view
    ui_rect picture;                           // pixels
} lens;

// `aspect`: width over height of the picture, which lies in the middle of the view.
lens lens_make(const roil_camera *camera, ui_rect view, float aspect);
// Returns where a point (m) is in the window (pixels). False: it is behind the eye.
bool lens_project(const lens *l, const float p[3], float out[2]);
// The same of a line, of which only the part before the eye is seen. False: none of it is.
bool lens_project_line(const lens *l, const float a[3], const float b[3], float out[4]);
// Returns the direction, of length 1, of the ray through a point of the window.
void lens_ray(const lens *l, float x, float y, float out[3]);
float lens_depth(const lens *l, const float p[3]);  // of a point, along the view (m)
float lens_pixels(const lens *l, const float p[3]); // that a metre across takes there

// Where the ray through a point of the window meets a plane, or comes nearest to a line, through
// `p` along `way`. False: nowhere before the eye.
bool lens_on_plane(const lens *l, float x, float y, const float p[3], const float normal[3],
                   float out[3]);
bool lens_on_line(const lens *l, float x, float y, const float p[3], const float way[3],
                  float out[3]);
// The same for a sphere; a ray that misses it gives the point that it passes. `far`: the farther
// of the two points.
void lens_on_sphere(const lens *l, float x, float y, const float centre[3], float radius, bool far,
                    float out[3]);
