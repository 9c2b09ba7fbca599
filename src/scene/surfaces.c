// Copies the surfaces of meshes to arrays over all meshes. Texels become linear half floats, since
// four are blended at a time, and decoding sRGB for each would cost more than their memory.
#include "scene/surfaces.h"
#include "base/memory.h"
#include "base/srgb.h"
#include <math.h>
#include <string.h>

_Static_assert(sizeof(struct surface_vertex) == sizeof(mesh_vertex), "copied as they are");

static void add_texture(surfaces *s, const mesh_texture *texture) {
    size_t count = (size_t)texture->width * texture->height;
    uint16_t linear[256], alpha[256];
    for (int i = 0; i < 256; i++) {
        linear[i] = half_from_float(linear_from_srgb((float)i / 255));
        alpha[i] = half_from_float((float)i / 255);
    }
    MEM_RESERVE(s->texels, s->texel_count + count, s->texel_capacity);
    for (size_t i = 0; i < count; i++) {
        uint16_t *out = s->texels[s->texel_count++];
        for (int c = 0; c < 3; c++) out[c] = linear[texture->pixels[4 * i + (size_t)c]];
        out[3] = alpha[texture->pixels[4 * i + 3]];
    }
}

bool surface_has_holes(const mesh_data *mesh, const mesh_part *part) {
    if (part->texture < 0) return part->color[3] < 0.5f;
    const mesh_texture *texture = &mesh->textures[part->texture];
    size_t count = (size_t)texture->width * texture->height;
    for (size_t i = 0; i < count; i++)
        if (part->color[3] * (float)texture->pixels[4 * i + 3] / 255 < 0.5f) return true;
    return false;
}

// `first`: the index of each texture's first texel.
static void add_material(surfaces *s, const mesh_data *mesh, const mesh_part *part,
                         const uint32_t *first) {
    struct surface_material *material =
        MEM_ADD(s->materials, s->material_count, s->material_capacity);
    *material = (struct surface_material){0};
    memcpy(material->color.v, part->color, sizeof part->color);
    if (part->texture < 0) return;
    const mesh_texture *texture = &mesh->textures[part->texture];
    bool holes = surface_has_holes(mesh, part);
    material->texture =
        (shared_uvec4){{texture->width, texture->height, first[part->texture], holes}};
    s->holes = s->holes || holes;
}

void surfaces_add(surfaces *s, const bvh_forest *f, size_t end, const mesh_data *mesh) {
    uint32_t vertex = (uint32_t)s->vertex_count;
    MEM_RESERVE(s->vertices, s->vertex_count + mesh->vertex_count, s->vertex_capacity);
    memcpy(s->vertices + s->vertex_count, mesh->vertices,
           mesh->vertex_count * sizeof *mesh->vertices);
    s->vertex_count += mesh->vertex_count;
    uint32_t *first = mem_alloc(mesh->texture_count * sizeof *first);
    for (uint32_t i = 0; i < mesh->texture_count; i++) {
        first[i] = (uint32_t)s->texel_count;
        add_texture(s, &mesh->textures[i]);
    }
    for (uint32_t i = 0; i < mesh->part_count; i++) add_material(s, mesh, &mesh->parts[i], first);
    mem_free(first);
    MEM_RESERVE(s->triangles, end, s->triangle_capacity);
    for (; s->triangle_count < end; s->triangle_count++) {
        bvh_origin from = f->origins[s->triangle_count];
        const uint32_t *corner = mesh->indices + from.first;
        s->triangles[s->triangle_count] =
            (shared_uvec4){{vertex + corner[0], vertex + corner[1], vertex + corner[2], from.part}};
    }
}

uint64_t surfaces_texels(const mesh_data *mesh) {
    uint64_t texels = 0;
    for (uint32_t i = 0; i < mesh->texture_count; i++)
        texels += (uint64_t)mesh->textures[i].width * mesh->textures[i].height;
    return texels;
}

uint64_t surfaces_largest(const mesh_data *mesh) {
    const uint64_t vertices = mesh->vertex_count * (uint64_t)sizeof *mesh->vertices;
    const uint64_t texels = 8 * surfaces_texels(mesh);
    return texels > vertices ? texels : vertices;
}

void surfaces_free(surfaces *s) {
    mem_free(s->triangles);
    mem_free(s->vertices);
    mem_free(s->materials);
    mem_free(s->texels);
    *s = (surfaces){0};
}
