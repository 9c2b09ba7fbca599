// Most scenes are matte: nothing shines, nothing mirrors. What shades them need not ask.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "scene/material.h"

static bool kinds_are_matte(scene_mesh *const *meshes, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!scene_mesh_is_matte(meshes[i])) return false;
    return true;
}

// Whether all that a pass shows, and has from those that it shows besides, is matte.
static bool is_matte(const pass *p) {
    int behind = pass_find_image(p, "scene_surface"); // of `pieces`
    if (!pass_is(p, "geometry") && !pass_is(p, "pieces")) return false;
    if (!kinds_are_matte(p->meshes, p->mesh_count)) return false;
    for (size_t i = 0; i < p->instances_count; i++) {
        scene_mesh *const *kinds;
        size_t count = scene_instances_kinds(p->instances[i], &kinds);
        if (!kinds_are_matte(kinds, count)) return false;
    }
    return behind < 0 || !p->images[behind].id;
}

void pass_drop_matte(pass *p, const char *surface, const char *emission) {
    const char *const names[] = {surface, emission};
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        graph_image *image = &p->images[pass_image_index(p, names[i])];
        const pass *writer = image->id ? pass_writer(p->host, *image) : NULL;
        if (writer && is_matte(writer)) *image = (graph_image){0};
    }
}
