// Whether maps are still what they were: where neither a light, nor what stands before it, nor the
// camera has moved, they need not be drawn again.
#include "pass/surfaces/shadow_maps_parts.h"

static void add(hash128 *sum, const void *data, size_t size) {
    *sum = hash_combine(*sum, hash_bytes(data, size));
}

static bool add_meshes(const pass *p, hash128 *sum) {
    mat4 place;
    float tint[4];
    for (size_t i = 0; i < p->mesh_count; i++) {
        if (!scene_mesh_place(p->meshes[i], p->host->context, place, tint)) return false;
        add(sum, place, sizeof place);
    }
    for (size_t i = 0; i < p->instances_count; i++) {
        const uint64_t shape = scene_instances_shape(p->instances[i]);
        if (!scene_instances_place(p->instances[i], p->host->context, place, tint)) return false;
        add(sum, place, sizeof place);
        add(sum, &shape, sizeof shape);
    }
    return true;
}

// The choice of lights, and of how far meshes are simplified, depends on where the camera is.
static void add_camera(const pass *p, hash128 *sum) {
    const struct frame_block *frame = p->host->frame;
    add(sum, &frame->eye, sizeof frame->eye);
    // The way it looks, which is the same wherever in a pixel its lines of sight go.
    for (int i = 0; i < 4; i++) add(sum, &frame->view.m[4 * i + 2], sizeof(float));
    add(sum, &frame->lens, sizeof frame->lens);
    add(sum, &frame->shift, 2 * sizeof *frame->shift.v);
    add(sum, p->host->lights, sizeof *p->host->lights);
}

bool shadow_maps_content(const pass *p, const kernel *places, bool choice, hash128 *out) {
    bool moves = pass_image(p, N_lights)->id != 0 || pass_image(p, N_point_lights)->id != 0;
    *out = hash_bytes(places->blocks[0], places->block_sizes[0]);
    if (choice || pass_value(p, N_lod) > 0) add_camera(p, out);
    return !(choice && moves) && add_meshes(p, out);
}
