// Meshes on the device: vertices and indices as storage buffers (vertices are pulled by the vertex
// shader), textures as sRGB images.
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "scene/instances.h"
#include "scene/material.h"
#include "scene/scene_impl.h"
#include <string.h>

static gpu_buffer *upload(gpu *g, const char *label, const void *data, size_t size) {
    gpu_buffer *buffer = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = label, .size = size, .kind = GPU_BUFFER_DEVICE});
    if (buffer && !gpu_buffer_write(g, buffer, 0, data, size)) {
        gpu_buffer_destroy(g, buffer);
        buffer = NULL;
    }
    return buffer;
}

static gpu_image *upload_texture(gpu *g, const char *label, const mesh_texture *texture) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){
                                               .label = label,
                                               .format = GPU_RGBA8_SRGB,
                                               .width = texture->width,
                                               .height = texture->height,
                                               .use = GPU_USE_SAMPLED,
                                           });
    size_t size = (size_t)texture->width * texture->height * 4;
    if (image && !gpu_image_write(g, image, 0, texture->pixels, size)) {
        gpu_image_destroy(g, image);
        image = NULL;
    }
    return image;
}

static size_t index_bytes(const mesh_data *data) {
    return ((size_t)data->index_count + data->level_index_count) * sizeof *data->indices;
}

void scene_mesh_list_memory(const scene_mesh *mesh, budget_list *out) {
    const mesh_data *data = &mesh->data;
    if (mesh->vertices) return;
    budget_list_add(out, mesh->name, data->vertex_count * sizeof *data->vertices);
    budget_list_add(out, mesh->name, index_bytes(data));
    for (uint32_t i = 0; i < data->texture_count; i++)
        budget_list_add(out, mesh->name,
                        4 * (uint64_t)data->textures[i].width * data->textures[i].height);
}

bool scene_mesh_upload(scene_mesh *mesh, gpu *g) {
    if (mesh->vertices) return true;
    const mesh_data *data = &mesh->data;
    mesh->textures = mem_alloc(data->texture_count * sizeof *mesh->textures);
    mesh->vertices =
        upload(g, mesh->name, data->vertices, data->vertex_count * sizeof *data->vertices);
    mesh->indices = upload(g, mesh->name, data->indices, index_bytes(data));
    bool done = mesh->vertices && mesh->indices;
    for (uint32_t i = 0; done && i < data->texture_count; i++) {
        mesh->textures[i] = upload_texture(g, mesh->name, &data->textures[i]);
        done = mesh->textures[i] != NULL;
    }
    if (!done) scene_mesh_destroy(mesh, g);
    return done;
}

void scene_mesh_destroy(scene_mesh *mesh, gpu *g) {
    if (!mesh->textures) return; // never uploaded
    for (uint32_t i = 0; i < mesh->data.texture_count; i++) gpu_image_destroy(g, mesh->textures[i]);
    gpu_buffer_destroy(g, mesh->vertices);
    gpu_buffer_destroy(g, mesh->indices);
    mem_free(mesh->textures);
    mesh->textures = NULL;
    mesh->vertices = mesh->indices = NULL;
}

bool scene_mesh_exchange(scene_mesh *mesh, scene_mesh *other) {
    if (mesh->data.vertices != other->data.vertices || // not shared by a cache
        mesh->data.textures != other->data.textures)
        return false;
    SWAP(mesh->vertices, other->vertices);
    SWAP(mesh->indices, other->indices);
    SWAP(mesh->textures, other->textures);
    return true;
}

// Returns the transform of one placement within its parent.
static bool place_matrix(const field *const place[3], const field_context *context, mat4 out) {
    float position[4], rotation[4], scale[4];
    if (!scene_evaluate(place[0], context, position) ||
        !scene_evaluate(place[1], context, rotation) || !scene_evaluate(place[2], context, scale))
        return false;
    vec3 angles = {glm_rad(rotation[0]), glm_rad(rotation[1]), glm_rad(rotation[2])};
    mat4 turn;
    glm_euler_zyx(angles, turn); // about X first, as fields are turned
    glm_translate_make(out, position);
    glm_mat4_mul(out, turn, out);
    glm_scale_uni(out, scale[0]);
    return true;
}

bool scene_node_transform(const scene_node *node, const field_context *context, mat4 out) {
    glm_mat4_identity(out);
    for (const scene_node *n = node; n; n = n->parent) {
        mat4 outer;
        if (!place_matrix((const field *[]){n->position, n->rotation, n->scale}, context, outer))
            return err_prefix("%s: ", n->name);
        glm_mat4_mul(outer, out, out);
    }
    return true;
}

bool scene_place_matrix(const field *position, const field *rotation, const field *scale,
                        const scene_node *parent, const field_context *context, mat4 out) {
    mat4 outer;
    if (!place_matrix((const field *[]){position, rotation, scale}, context, out) ||
        !scene_node_transform(parent, context, outer))
        return false;
    glm_mat4_mul(outer, out, out);
    return true;
}

bool scene_mesh_transform(const scene_mesh *mesh, const field_context *context, mat4 out) {
    if (mesh->instances)
        return scene_instances_transform(mesh->instances, mesh->index, mesh->kind, context, out);
    return scene_place_matrix(mesh->position, mesh->rotation, mesh->scale, mesh->parent, context,
                              out);
}

bool scene_mesh_place(const scene_mesh *mesh, const field_context *context, mat4 transform,
                      float tint[4]) {
    scene_look look;
    if (!scene_mesh_transform(mesh, context, transform)) return err_prefix("%s: ", mesh->name);
    if (!scene_mesh_look(mesh, context, &look)) return false;
    memcpy(tint, look.tint, sizeof look.tint);
    return true;
}
