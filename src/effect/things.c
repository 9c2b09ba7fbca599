// What of an effect stands somewhere in space.
#include "effect/things.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <stdio.h>
#include <string.h>

enum { MOST_NAME = 160 };

void effect_add_shape(effect *e, const char *name, const field *node) {
    if (strcmp(node->kind->group, "shape") != 0) return;
    *MEM_ADD(e->shapes, e->shape_count, e->shape_capacity) = (effect_shape){name, node};
}

size_t effect_shapes(const effect *e, const effect_shape **out) {
    *out = e->shapes;
    return e->shape_count;
}

size_t effect_nodes(const effect *e, scene_node *const **out) {
    *out = e->nodes;
    return e->node_count;
}

size_t effect_meshes(const effect *e, scene_mesh *const **out) {
    *out = e->meshes;
    return e->mesh_count;
}

size_t effect_grids(const effect *e, field_grid *const **out) {
    *out = e->grids;
    return e->grid_count;
}

static bool is_behind(const control *c, const field *node) {
    if (c->slot ? *c->slot == node : c->nodes[0] == node) return field_is_constant(node);
    if (c->face.kind == EFFECT_CONTROL_PARAM)
        return strcmp(node->kind->name, "param") == 0 && (size_t)node->index == c->face.index;
    return c->face.kind == EFFECT_CONTROL_CURVE && c->curve && node->object == c->curve;
}

const effect_control *effect_control_behind(const effect *e, const field *node) {
    for (size_t i = 0; node && i < e->control_count; i++)
        if (is_behind(e->controls[i], node)) return &e->controls[i]->face;
    return NULL;
}

const effect_control *effect_control_named(effect *e, const char *group, const char *name) {
    char whole[MOST_NAME];
    snprintf(whole, sizeof whole, "%s.%s", group, name);
    const control *c = effect_control_of(e, whole);
    return c ? &c->face : NULL;
}
