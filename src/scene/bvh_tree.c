// Makes trees: visible triangles become pieces, and leaves become ranges of triangles.
#include "scene/bvh_tree.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/srgb.h"
#include <float.h>
#include <math.h>

static const float node_cost = 2; // between 1 and 3 a GPU takes as long, within 3 %

typedef struct builder {
    bvh_forest *forest;
    const mesh_data *mesh;
    float (*colors)[3]; // per part
    bvh_piece *pieces;
    size_t piece_count, piece_capacity;
} builder;

// ---- pieces -----------------------------------------------------------------------------------

static const float *corner(const mesh_data *mesh, uint32_t index) {
    return mesh->vertices[mesh->indices[index]].position;
}

static bool has_area(const float *a, const float *b, const float *c) {
    vec3 first, second, across;
    glm_vec3_sub((float *)b, (float *)a, first);
    glm_vec3_sub((float *)c, (float *)a, second);
    glm_vec3_cross(first, second, across);
    float squared = glm_vec3_norm2(across);
    return isfinite(squared) && squared >= FLT_MIN;
}

static void add_pieces(builder *b, uint32_t part, uint32_t level) {
    const mesh_part *look = &b->mesh->parts[part];
    mesh_run run = mesh_get_run(b->mesh, part, level);
    if (look->texture < 0 && look->color[3] < 0.5f) return; // clear, as when it is drawn
    for (uint32_t i = run.first; i + 2 < run.first + run.count; i += 3) {
        const float *corners[3];
        for (uint32_t c = 0; c < 3; c++) corners[c] = corner(b->mesh, i + c);
        if (!has_area(corners[0], corners[1], corners[2])) continue;
        bvh_piece *p = MEM_ADD(b->pieces, b->piece_count, b->piece_capacity);
        *p = (bvh_piece){.box = bvh_bounds_empty(), .first = i, .part = part};
        for (int c = 0; c < 3; c++) {
            bvh_bounds point;
            glm_vec3_copy((float *)corners[c], point.low);
            glm_vec3_copy((float *)corners[c], point.high);
            bvh_bounds_add(&p->box, &point);
        }
        for (int a = 0; a < 3; a++) p->middle[a] = 0.5f * p->box.low[a] + 0.5f * p->box.high[a];
    }
}

// Returns the mean of a texture, linear. Rays use no more of it than that.
static void mean_color(const mesh_texture *texture, float out[3]) {
    float linear[256];
    for (int i = 0; i < 256; i++) linear[i] = linear_from_srgb((float)i / 255);
    size_t count = (size_t)texture->width * texture->height;
    double sum[3] = {0};
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) sum[c] += (double)linear[texture->pixels[4 * i + (size_t)c]];
    for (int c = 0; c < 3; c++) out[c] = count ? (float)(sum[c] / (double)count) : 1;
}

static void find_color(const mesh_data *mesh, const mesh_part *part, float out[3]) {
    float texture[3] = {1, 1, 1};
    if (part->texture >= 0) mean_color(&mesh->textures[part->texture], texture);
    for (int c = 0; c < 3; c++) out[c] = part->color[c] * texture[c];
}

// ---- nodes ------------------------------------------------------------------------------------

static void add_triangle(builder *b, const bvh_piece *p) {
    bvh_forest *f = b->forest;
    MEM_RESERVE(f->triangles, f->triangle_count + 1, f->triangle_capacity);
    MEM_RESERVE(f->origins, f->triangle_count + 1, f->origin_capacity);
    f->origins[f->triangle_count] = (bvh_origin){p->first, p->part};
    struct bvh_triangle *t = &f->triangles[f->triangle_count++];
    const float *from = corner(b->mesh, p->first), *color = b->colors[p->part];
    const float *first = corner(b->mesh, p->first + 1), *second = corner(b->mesh, p->first + 2);
    for (int a = 0; a < 3; a++) {
        t->corner.v[a] = from[a];
        t->first.v[a] = first[a] - from[a];
        t->second.v[a] = second[a] - from[a];
    }
    t->corner.v[3] = color[0];
    t->first.v[3] = color[1];
    t->second.v[3] = color[2];
}

static uint32_t add_leaf(void *user, const bvh_piece *pieces, size_t count) {
    builder *b = user;
    size_t first = b->forest->triangle_count;
    for (size_t i = 0; i < count; i++) add_triangle(b, &pieces[i]);
    return (uint32_t)first;
}

bool bvh_forest_add(bvh_forest *f, const mesh_data *mesh, uint32_t level) {
    if (f->triangle_count + mesh->index_count / 3 > BVH_MAX_TRIANGLES)
        return err_set("all meshes together have more than %d triangles", BVH_MAX_TRIANGLES);
    builder b = {.forest = f, .mesh = mesh};
    b.colors = mem_alloc(mesh->part_count * sizeof *b.colors);
    for (uint32_t i = 0; i < mesh->part_count; i++) {
        find_color(mesh, &mesh->parts[i], b.colors[i]);
        add_pieces(&b, i, level);
    }
    bvh_build made = {.nodes = f->nodes,
                      .node_count = f->node_count,
                      .node_capacity = f->node_capacity,
                      .add_leaf = add_leaf,
                      .user = &b,
                      .node_cost = node_cost};
    bvh_build_tree(&made, b.pieces, b.piece_count);
    f->nodes = made.nodes;
    f->node_count = made.node_count;
    f->node_capacity = made.node_capacity;
    mem_free(b.colors);
    mem_free(b.pieces);
    return true;
}

void bvh_forest_free(bvh_forest *f) {
    mem_free(f->nodes);
    mem_free(f->triangles);
    mem_free(f->origins);
    *f = (bvh_forest){0};
}
