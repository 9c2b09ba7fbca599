// Instances: many copies of a few meshes, each with a place, a look and four numbers of the
// effect's own, which the script may change at any time. The host holds all; what has changed goes
// to the device once a frame, in runs.
#pragma once
#include "scene/scene.h"

typedef struct scene_instances scene_instances;

enum {
    SCENE_INSTANCES_MAX = 1 << 17,  // of one object
    SCENE_INSTANCES_ALL = 1 << 18,  // of an effect
    SCENE_INSTANCES_MAX_KINDS = 64, // meshes of one object
    SCENE_INSTANCES_COST = 512,     // bytes of host memory that an instance takes, about
};

typedef struct scene_instances_desc {
    const char *name;         // for messages; must outlive it
    scene_mesh *const *kinds; // instance_entry.kind.x counts these; copied
    size_t kind_count;
    const struct instance_entry *entries; // as they begin; copied, and numbered
    size_t count;
    // Of all together, as of a mesh.
    const field *position, *rotation, *scale, *color;
    const scene_node *parent; // NULL: the world
} scene_instances_desc;

scene_instances *scene_instances_create(const scene_instances_desc *desc);
void scene_instances_destroy(scene_instances *s, gpu *g);
const char *scene_instances_name(const scene_instances *s);
size_t scene_instances_kinds(const scene_instances *s, scene_mesh *const **out);
uint32_t scene_instances_count(const scene_instances *s);

// As they are now, by number.
const struct instance_entry *scene_instances_entries(const scene_instances *s);
// Replaces all but the number and the random number. What is no number of a place becomes what it
// was before.
void scene_instances_set(scene_instances *s, uint32_t index, const struct instance_entry *entry);
void scene_instances_reset(scene_instances *s); // to how they began: time has gone back
// Another one after each change; at least 1.
uint64_t scene_instances_version(const scene_instances *s);
// The same, but for changes of colours and of the effect's own numbers.
uint64_t scene_instances_shape(const scene_instances *s);

// Of all together: their space to the world, and what multiplies their colours.
bool scene_instances_place(const scene_instances *s, const field_context *context, mat4 transform,
                           float tint[4]);
// Of one, within that space.
void scene_instances_matrix(const struct instance_entry *entry, mat4 out);
// Of one to the world, as long as it is of that kind; else all of it is in one point.
bool scene_instances_transform(const scene_instances *s, uint32_t index, uint32_t kind,
                               const field_context *context, mat4 out);
// One as a mesh by itself, in `memory`, as long as it is of the kind that it is now; NULL: it is
// not shown.
scene_mesh *scene_instances_mesh(const scene_instances *s, uint32_t index, arena *memory);

// The storage buffer "Instances". Allocate on the device's thread, again: does nothing; upload
// inside a frame, once a frame: only what changed.
void scene_instances_list_memory(const scene_instances *s, budget_list *out); // that it lacks
bool scene_instances_allocate(scene_instances *s, gpu *g);
bool scene_instances_upload(scene_instances *s, gpu *g);
gpu_buffer *scene_instances_buffer(const scene_instances *s);

// Those within `radius` of a point of their space, the nearest first, at most `capacity`; returns
// how many there are. By a grid over their places, which is made anew when one has moved.
size_t scene_instances_near(scene_instances *s, const float point[3], float radius, uint32_t *out,
                            size_t capacity);
