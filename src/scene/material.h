// The surface of a mesh as a script sets it. What the script does not set is taken from the mesh's
// file, part by part.
#pragma once
#include "scene/scene.h"

struct scene_material {
    const char *name;                             // name for its controls; NULL: none
    const field *color;                           // vec3, replaces the file's, for all parts
    const field *specular, *roughness, *metallic; // 0 to 1
    const field *emission;                        // vec3, radiance
    const mesh_texture *texture;                  // replaces the file's, for all parts
    bool no_toon;                                 // toon shading does not apply
};

// Gives a mesh the material, before anything else is done with it. What it colours anew no longer
// shares its parts with meshes of the same file. `memory` holds what that takes.
void scene_mesh_set_material(scene_mesh *mesh, const scene_material *material, arena *memory);
// Returns whether the mesh has only a colour: no highlights and no emission.
bool scene_mesh_is_matte(const scene_mesh *mesh);
bool scene_mesh_glows(const scene_mesh *mesh); // it emits light, or may at some time

// The look of a mesh in a frame. Negative values: the part's own.
typedef struct scene_look {
    float tint[3]; // factor of the parts' colours
    float specular, roughness, metallic;
    float emission[3];
    float toon; // 1: toon shading may apply
} scene_look;

bool scene_mesh_look(const scene_mesh *mesh, const field_context *context, scene_look *out);
// Returns the look of a part. `surface`: specular, roughness, metallic, toon; `emission`: RGB and
// 0.
void scene_look_part(const scene_look *look, const mesh_part *part, float surface[4],
                     float emission[4]);
