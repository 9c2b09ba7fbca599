// The scene around the volume: camera, sun, sky, lights and meshes. Every number is a field that
// does not vary in space, so that it can be a constant, a parameter, a curve or a Lua function.
#pragma once
#include "base/value.h"
#include "field/field.h"
#include "media/mesh.h"
#include "shared.h"

typedef struct scene_camera {
    const field *eye;        // vec3, metres; NULL: orbits the target
    const field *target;     // vec3, metres
    const field *distance;   // metres from the target, when orbiting
    const field *yaw;        // degrees about +Z; 0 looks along +Y
    const field *pitch;      // degrees above the horizon of the eye as seen from the target
    const field *fov;        // vertical field of view, degrees
    const field *near, *far; // metres
    const field
        *orthographic; // metres from the lower edge of the picture to the upper; 0: perspective
    const field *aperture, *focus; // diameter of the lens, depth that is sharp (0: the target's); m
} scene_camera;

typedef struct scene_sun {
    const field *azimuth;   // degrees about +Z from +X towards the sun
    const field *elevation; // degrees above the horizon
    const field *color;     // vec3
    const field *strength;  // irradiance at normal incidence
    const field *angle;     // degrees across
} scene_sun;

typedef struct scene_sky {
    const field *zenith, *horizon; // vec3, radiance
    const field *strength;
    const field *rotation; // degrees about +Z, of the image
    const field *night;    // 0..1: how much of the sky is night; NULL: there is none
    const field *night_zenith, *night_horizon; // vec3, radiance
    const field *stars;                        // factor of what they and the moon shine
    const field *moon;                         // degrees across, where the sun stands; 0: none
    const struct sky_image *image; // instead of the two colours; NULL: none (sky_image.h)
} scene_sky;

typedef enum scene_light_kind { // as LIGHT_POINT, LIGHT_SPOT of shared.h
    SCENE_POINT = 1,
    SCENE_SPOT = 2,
} scene_light_kind;

typedef struct scene_light {
    const char *name; // that its numbers are set by; NULL: none
    scene_light_kind kind;
    const field *position; // vec3, metres
    const field *color;    // vec3
    const field *power;    // watt, into all directions; a spot's is that of the point light that
                           // its cone is cut from, as in Blender
    const field *radius;   // metres; above 0 a glowing sphere
    const field *range;    // metres, beyond which nothing is lit; NULL or 0: it has none
    bool linear;           // falls off so, up to its range; else as light does
    const field *target;   // vec3, metres: where a spot shines
    const field *angle;    // degrees across a spot's cone
    const field *softness; // 0..1: part of the cone over which it fades
} scene_light;

typedef struct scene_node {          // a transform that meshes and instances can be placed in
    const char *name;                // in messages, and that its numbers are set by
    const field *position;           // vec3, metres
    const field *rotation;           // vec3, degrees about X, then Y, then Z
    const field *scale;              // factor
    const struct scene_node *parent; // NULL: the world
} scene_node;

typedef struct scene_material scene_material;

typedef struct scene_mesh {
    const char *name;   // its file
    const char *called; // that its numbers are set by; NULL: they are not
    bool repeated;      // stands where instances or particles are
    mesh_data data;
    const field *position;                   // vec3, metres
    const field *rotation;                   // vec3, degrees about X, then Y, then Z
    const field *scale;                      // factor
    const scene_node *parent;                // NULL: the world
    const struct scene_instances *instances; // the mesh is one of these instances; NULL: it is not
    uint32_t index, kind;                    // number of the instance, shown while of this kind
    const field *color;                      // vec3, multiplies the material's
    const scene_material *material;          // material.h; NULL: the file's
    gpu_buffer *vertices, *indices;          // made on first use
    gpu_image **textures;                    // per mesh_data texture
} scene_mesh;

typedef struct scene {
    scene_camera camera;
    scene_sun sun;
    scene_sky sky;
    scene_light *lights; // besides the sun; the script's memory
    size_t light_count;  // less than LIGHT_MAX
} scene;

typedef enum scene_need { // where a value is at all
    SCENE_ALWAYS = 0,
    SCENE_ORBIT = 1,    // of a camera that circles its target
    SCENE_GRADIENT = 2, // of a sky without an image
    SCENE_IMAGE = 4,    // of a sky with one
    SCENE_NIGHT = 8,    // of a sky that has a night
    SCENE_SPHERE = 16,  // of a light that may be a glowing sphere
    SCENE_CONE = 32,    // of a spot light
    SCENE_ALL = 63,
} scene_need;

typedef struct scene_value { // a field that a structure of the scene holds
    value_desc desc;
    size_t offset; // of the field in the structure
    scene_need need;
} scene_value;
// By structure; a NULL name ends each.
extern const scene_value scene_camera_values[], scene_sun_values[], scene_sky_values[],
    scene_light_values[], scene_material_values[], scene_mesh_values[], scene_node_values[];
const field **scene_slot(void *structure, const scene_value *value);
// Constants in `memory` for all fields that are NULL, have a default and no other needs.
void scene_set_defaults(const scene_value *values, unsigned needs, void *structure, arena *memory);
bool scene_has(const scene *s, scene_need need);

// A scene with the defaults of the documentation, made of constants in `memory`.
void scene_init(scene *s, arena *memory);
// Evaluates camera, sun and sky into the block that shaders read. The caller sets the block's time
// and size; `last` is set as in a first frame. `aspect`: width over height. False with a message
// when a Lua function failed.
bool scene_fill_frame(const scene *s, const field_context *context, float aspect,
                      struct frame_block *out);

// Moves the camera of a picture within what a lens sees: its lines of sight by a part of the
// picture (1: its width, its height; to the right, down), its eye within the lens (-1 to 1 of its
// radius; to the right, up), while what is in focus stays where it is. `last` stays. Shaders need
// not know.
void scene_move_sight(struct frame_block *frame, const float picture[2], const float lens[2]);

// Evaluates sun and lights; the sun is the first, whatever its strength.
bool scene_fill_lights(const scene *s, const field_context *context, struct light_block *out);

// Returns the unit vector for angles in degrees: about +Z from +X, and above the horizon.
void scene_direction(float azimuth, float elevation, vec3 out);
// Returns the camera's position and target (m).
bool scene_camera_eye(const scene_camera *c, const field_context *context, vec3 eye, vec3 target);

void scene_mesh_list_memory(const scene_mesh *mesh, budget_list *out); // of what is not uploaded
bool scene_mesh_upload(scene_mesh *mesh, gpu *g);
// Exchanges the device memory of two meshes. False when they do not have the same data.
bool scene_mesh_exchange(scene_mesh *mesh, scene_mesh *other);
void scene_mesh_destroy(scene_mesh *mesh, gpu *g);
bool scene_mesh_transform(const scene_mesh *mesh, const field_context *context, mat4 out);
// Returns the transform of a node and of those that it is placed in; of NULL, none.
bool scene_node_transform(const scene_node *node, const field_context *context, mat4 out);
// Returns the transform and the colour. False with a message that names the mesh.
bool scene_mesh_place(const scene_mesh *mesh, const field_context *context, mat4 transform,
                      float tint[4]);
