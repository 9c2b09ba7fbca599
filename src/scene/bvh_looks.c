// The look of the parts of all meshes in a frame, for passes that show them by rays: from their
// files, changed by what the script sets.
#include "base/memory.h"
#include "scene/bvh_impl.h"
#include "scene/material.h"
#include <string.h>

void bvh_looks_count(scene_bvh *b) {
    b->materials = mem_alloc(b->mesh_count * sizeof *b->materials);
    b->material_count = 0;
    for (size_t i = 0; i < b->mesh_count; i++) {
        b->materials[i] = (uint32_t)b->material_count;
        b->material_count += b->meshes[i]->data.part_count;
    }
}

bool scene_bvh_glows(const scene_bvh *b) {
    for (size_t i = 0; i < b->mesh_count; i++)
        if (scene_mesh_glows(b->meshes[i])) return true;
    return false;
}

// Returns the first mesh that has the same tree as another.
static size_t first_of_tree(const scene_bvh *b, size_t mesh) {
    size_t i = 0;
    while (b->trees[i].root != b->trees[mesh].root || b->trees[i].end != b->trees[mesh].end) i++;
    return i;
}

void bvh_looks_add(scene_bvh *b, surfaces *s, size_t mesh) {
    const tree *t = &b->trees[mesh];
    if (!b->looks) b->looks = mem_alloc(b->material_count * sizeof *b->looks);
    if (t->root == t->end) return; // nothing of it is to be seen
    struct surface_material *out = &b->looks[b->materials[mesh]];
    size_t parts = b->meshes[mesh]->data.part_count, before = s->material_count;
    if (t->triangles > s->triangle_count) {
        surfaces_add(s, &b->forest, t->triangles, &b->meshes[mesh]->data);
        memcpy(out, s->materials + before, parts * sizeof *out);
    } else {
        memcpy(out, &b->looks[b->materials[first_of_tree(b, mesh)]], parts * sizeof *out);
    }
}

static bool look_at(scene_bvh *b, size_t mesh, const field_context *context, bool *changed) {
    const mesh_data *data = &b->meshes[mesh]->data;
    scene_look look;
    if (!scene_mesh_look(b->meshes[mesh], context, &look)) return false;
    for (uint32_t i = 0; i < data->part_count; i++) {
        struct surface_material *now = &b->looks[b->materials[mesh] + i], made = *now;
        scene_look_part(&look, &data->parts[i], made.surface.v, made.emission.v);
        *changed = *changed || memcmp(now, &made, sizeof made) != 0;
        *now = made;
    }
    return true;
}

bool bvh_looks_update(scene_bvh *b, gpu *g, const field_context *context) {
    if (!b->looks || b->material_count == 0) return true;
    bool changed = !b->looked;
    for (size_t i = 0; i < b->mesh_count; i++)
        if ((!b->looked || b->meshes[i]->material) && !look_at(b, i, context, &changed))
            return false;
    b->looked = true;
    b->version += changed;
    return !changed || gpu_buffer_write(g, b->buffers[BVH_MATERIALS], 0, b->looks,
                                        b->material_count * sizeof *b->looks);
}
