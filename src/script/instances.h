// Values of single instances, shared by l_instances.c and l_instances_make.c.
#pragma once
#include "scene/instances.h"
#include "script/binding.h"

typedef struct instances_object {
    scene_instances *instances;
} instances_object;

// Values of an instance, in the order in which they are applied: a rotation before a yaw.
typedef enum instance_key {
    INSTANCE_POSITION,
    INSTANCE_ROTATION,
    INSTANCE_YAW,
    INSTANCE_SCALE,
    INSTANCE_KIND,
    INSTANCE_COLOR,
    INSTANCE_GLOW,
    INSTANCE_STATE,
    INSTANCE_KEYS
} instance_key;

extern const char *const instance_key_names[INSTANCE_KEYS];

// Sets one of them from the value at `index` of the stack. Raises an error when it is not valid.
// `kinds` is the number of kinds.
void instance_read(lua_State *L, int index, const char *who, instance_key key, size_t kinds,
                   struct instance_entry *out);
bool instance_is_list(lua_State *L, int index, instance_key key); // a list of such values

// The yaw is a rotation about +Z after all other rotations, in degrees.
float instance_yaw(const struct instance_entry *entry);
void instance_set_yaw(struct instance_entry *entry, float degrees);
int l_instances(lua_State *L); // the constructor
