// What a script says of the surface of a mesh. What it says nothing about is as the mesh's file has
// it, part by part.
#pragma once
#include "scene/scene.h"

struct scene_material {
    const char *name;                             // that its numbers are set by; NULL: none
    const field *color;                           // vec3, of all parts, instead of the file's
    const field *specular, *roughness, *metallic; // 0..1
    const field *emission;                        // vec3, radiance
    const mesh_texture *texture;                  // of all parts, instead of the file's
    bool no_toon;                                 // light comes in no bands
};

// Gives a mesh the material, before anything else is done with it. What it colours anew no longer
// shares its parts with meshes of the same file. `memory` holds what that takes.
void scene_mesh_set_material(scene_mesh *mesh, const scene_material *material, arena *memory);
// Nothing but its colour is to be seen of it: no highlights, no light of its own.
bool scene_mesh_is_matte(const scene_mesh *mesh);
bool scene_mesh_glows(const scene_mesh *mesh); // or may at some time

// What is said of a mesh, as of a frame. Below 0: what its part says.
typedef struct scene_look {
    float tint[3]; // factor of the parts' colours
    float specular, roughness, metallic;
    float emission[3];
    float toon; // 1: light may come in bands
} scene_look;

bool scene_mesh_look(const scene_mesh *mesh, const field_context *context, scene_look *out);
// `surface`: specular, roughness, metallic, toon; `emission`: rgb and 0.
void scene_look_part(const scene_look *look, const mesh_part *part, float surface[4],
                     float emission[4]);
