// An effect as a part of a host's picture: the host's renderer gives its camera, lights and depths,
// and gets the medium of the effect as a layer that it composes. Part of roil.h, which includes it;
// its rules on errors, threads and memory hold here too. Images on the device are handed over by
// roil_vulkan.h.
//
// A layer is composed by
//
//   picture = layer.color.rgb + layer.transmittance.rgb * picture
//
// and of several layers the farthest goes first.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_layer_desc {
    // Name of a pass march, whose medium it is. NULL: all media that the effect's picture shows, at
    // most three: those of marches that passes `over` lay over it. Where these are none, as where
    // marches are only counted and coloured by `bands`, it is the first march.
    const char *source;
    bool motion; // ROIL_LAYER_MOTION is wanted
} roil_layer_desc;

typedef enum roil_layer_image {
    ROIL_LAYER_COLOR,         // scene-linear radiance, premultiplied, and opacity; rgba16f
    ROIL_LAYER_TRANSMITTANCE, // part of what is behind that shines through, by colour; rgba16f
    // Depth of the place where the opacity of a pixel is on average, along the camera's axis and in
    // the unit of its space; where there is no medium, that of the host's scene, or 1e9; r32f.
    ROIL_LAYER_DEPTH,
    // Where that place is in the picture, less where it was in the frame before: parts of the
    // picture's width to the right and of its height down, without jitter; rg16f. It has the
    // camera's motion, and the medium's own where a grid of its density has a velocity or `advect`
    // carries it; of several media the mean by what is seen of each.
    ROIL_LAYER_MOTION,
    ROIL_LAYER_IMAGES
} roil_layer_image;

// Makes the effect draw its media alone, before no mesh, sky or sprite of its own and without bloom
// or tone mapping, into the images of a layer. Of several media the nearer one lies before the
// other in each pixel, whichever way the script lays them; where they go through each other the
// order is a mean. All have the finest of their resolutions. A warning in the log names what else
// the effect would draw: other marches and stacks, sprites, shells, glows, meshes and their pieces.
// Call it after roil_load and before roil_prepare, once. False with a message: it has no such pass,
// or its frames are averages (roil_set_samples).
bool roil_make_layer(roil_effect *e, const roil_layer_desc *desc);
// Returns the name of an image of the layer, as roil_keep and roil_read_begin take it; NULL with a
// message: there is none.
const char *roil_get_layer_image(const roil_effect *e, roil_layer_image image);

typedef struct roil_view {
    // Column-major matrices. `view` goes from the effect's space (metres, z up) to the camera's:
    // what places the effect in the host's world belongs to it, and it may scale evenly. The camera
    // may look along -z or +z, with y up.
    float view[16];
    // From the camera's space to clip space, with depths from 0 to 1, ordinary or reversed, with an
    // end or without one. Up is up in the picture, whichever way y goes in clip space.
    float projection[16];
    float jitter[2]; // pixels by which the picture is moved to the right and down; not in
                     // `projection`
} roil_view;
// Sets the camera of the frames from now on. NULL: the script's own. False with a message, and
// nothing changes, when the projection is no perspective.
bool roil_set_view(roil_effect *e, const roil_view *view);

typedef struct roil_sun {
    float towards[3];    // the sun, in the effect's space; of any length
    float irradiance[3]; // at normal incidence (W/m^2)
    float angle;         // across (degrees)
} roil_sun;
typedef struct roil_point_light {
    float position[3];  // m
    float intensity[3]; // W/sr
    float radius;       // m, above 0: a glowing sphere
    float range;        // m, beyond which nothing is lit; 0: none
} roil_point_light;
typedef struct roil_lights {
    const roil_sun *sun; // NULL: it does not shine
    const roil_point_light *points;
    size_t count; // at most as many as `lights` of the effect declares
} roil_lights;
// Replaces sun and lights of the script in the frames from now on. NULL: the script's own. Light of
// the sky stays the script's ("sky.strength").
bool roil_set_lights(roil_effect *e, const roil_lights *lights);

// An image of the last frame on its way from the device.
typedef struct roil_readback roil_readback;
// Begins to read an image that is kept: its name, or NULL for the layer's colour, or else the
// scene-linear picture, or else the one that is shown. Returns at once. Call it after roil_render,
// and roil_unload after roil_read_end. NULL with a message.
roil_readback *roil_read_begin(roil_effect *e, const char *image);
// It has arrived, or never will since the device is lost, as one is that has finished nothing for
// roil_desc.timeout: then roil_read_end fails. Never waits.
bool roil_read_ready(roil_readback *b);
void roil_read_size(const roil_readback *b, uint32_t *width, uint32_t *height);
// Writes four floats for each pixel, rows from the top, and frees `b`; `out` NULL only frees it.
// Waits if it has not arrived. Missing channels are 0, and alpha 1. False with a message.
bool roil_read_end(roil_readback *b, float *out);

#ifdef __cplusplus
}
#endif
