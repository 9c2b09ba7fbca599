// Instances: many copies of a few meshes, each with a placement, a look and four numbers for the
// effect's use, which the script may change at any time. The host holds all of them; changes are
// copied to the device once per frame.
#pragma once
#include "scene/scene.h"

typedef struct scene_instances scene_instances;

enum {
    SCENE_INSTANCES_MAX = 1 << 17,  // per object
    SCENE_INSTANCES_ALL = 1 << 18,  // per effect
    SCENE_INSTANCES_MAX_KINDS = 64, // meshes per object
    SCENE_INSTANCES_COST = 512,     // approximate bytes of host memory of an instance
};

typedef struct scene_instances_desc {
    const char *name;         // for messages; must outlive the object
    scene_mesh *const *kinds; // instance_entry.kind.x is an index in these; copied
    size_t kind_count;
    const struct instance_entry *entries; // initial state; copied, and numbered
    size_t count;
    // Placement and colour of all instances together, as of a mesh.
    const field *position, *rotation, *scale, *color;
    const scene_node *parent; // NULL: the world
} scene_instances_desc;

scene_instances *scene_instances_create(const scene_instances_desc *desc);
void scene_instances_destroy(scene_instances *s, gpu *g);
const char *scene_instances_name(const scene_instances *s);
size_t scene_instances_kinds(const scene_instances *s, scene_mesh *const **out);
uint32_t scene_instances_count(const scene_instances *s);

// Returns the instances of now, by number.
const struct instance_entry *scene_instances_entries(const scene_instances *s);
// Replaces an instance, except for its number and its random number. Numbers of its placement that
// are not finite keep their old value.
void scene_instances_set(scene_instances *s, uint32_t index, const struct instance_entry *entry);
void scene_instances_reset(scene_instances *s); // back to the initial state
// Returns a number that changes with each change; at least 1.
uint64_t scene_instances_version(const scene_instances *s);
// The same, except for changes of colours and of the numbers for the effect's use.
uint64_t scene_instances_shape(const scene_instances *s);

// Returns the transform of all instances to the world, and the factor of their colours.
bool scene_instances_place(const scene_instances *s, const field_context *context, mat4 transform,
                           float tint[4]);
// Returns the transform of one instance within that space.
void scene_instances_matrix(const struct instance_entry *entry, mat4 out);
// Returns the transform of one instance to the world. It collapses to a point when the instance is
// not of that kind.
bool scene_instances_transform(const scene_instances *s, uint32_t index, uint32_t kind,
                               const field_context *context, mat4 out);
// Returns one instance as a mesh, in `memory`, which is visible while the instance is of its
// present kind. NULL: the instance is not shown.
scene_mesh *scene_instances_mesh(const scene_instances *s, uint32_t index, arena *memory);

// The storage buffer "Instances". Allocate on the device's thread, again: does nothing; upload
// inside a frame, once a frame: only what changed.
void scene_instances_list_memory(const scene_instances *s, budget_list *out); // that it lacks
bool scene_instances_allocate(scene_instances *s, gpu *g);
bool scene_instances_upload(scene_instances *s, gpu *g);
gpu_buffer *scene_instances_buffer(const scene_instances *s);

// Lists the instances within `radius` of a point in their space, the nearest first, at most
// `capacity`. Returns how many there are. Uses a grid, which is rebuilt when an instance has moved.
size_t scene_instances_near(scene_instances *s, const float point[3], float radius, uint32_t *out,
                            size_t capacity);
