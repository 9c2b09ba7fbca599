// Where a source of simulated air is: the cells of its box while its values hold.
#include "pass/air/air_parts.h"
#include <math.h>

bool air_mesh_box(const air *a, const scene_mesh *mesh, const field_context *context, box3 *out) {
    const float corners[2][3] = {
        {mesh->data.box.min.x, mesh->data.box.min.y, mesh->data.box.min.z},
        {mesh->data.box.max.x, mesh->data.box.max.y, mesh->data.box.max.z}};
    mat4 place;
    if (!scene_mesh_transform(mesh, context, place)) return false;
    for (int i = 0; i < 8; i++) {
        vec3 p = {corners[i & 1][0], corners[i >> 1 & 1][1], corners[i >> 2][2]}, q;
        glm_mat4_mulv3(place, p, 1, q);
        box3 point = {{q[0], q[1], q[2]}, {q[0], q[1], q[2]}};
        if (i == 0) *out = point;
        out->min =
            (float3){fminf(out->min.x, q[0]), fminf(out->min.y, q[1]), fminf(out->min.z, q[2])};
        out->max =
            (float3){fmaxf(out->max.x, q[0]), fmaxf(out->max.y, q[1]), fmaxf(out->max.z, q[2])};
    }
    const float h = (float)a->desc.voxel_size;
    out->min = (float3){out->min.x - h, out->min.y - h, out->min.z - h};
    out->max = (float3){out->max.x + h, out->max.y + h, out->max.z + h};
    return true;
}

// Meshes go on from where they are at the context's time to where they are at `end`.
static bool meshes_box(const air *a, const pass *p, double end, box3 *out) {
    field_context then = *p->host->context;
    *out = box3_empty();
    for (size_t i = 0; i < 2 * p->mesh_count; i++) {
        box3 one;
        if (i == p->mesh_count) then.time = end;
        if (!air_mesh_box(a, p->meshes[i % p->mesh_count], &then, &one)) return false;
        *out = i ? box3_union(*out, one) : one;
    }
    return true;
}

// Cells whose middle the box may hold; none: of no size.
static air_cells cells_of(const air *a, box3 box) {
    air_cells out = {{0, 0, 0}, {0, 0, 0}};
    box = box3_intersect(box, a->grid.box);
    if (box3_is_empty(box)) return out;
    const float h = (float)a->desc.voxel_size;
    const float3 corner = a->grid.box.min;
    const float low[3] = {box.min.x - corner.x, box.min.y - corner.y, box.min.z - corner.z};
    const float high[3] = {box.max.x - corner.x, box.max.y - corner.y, box.max.z - corner.z};
    for (int i = 0; i < 3; i++) {
        float n = (float)a->desc.size[i];
        out.first[i] = clampf(floorf(low[i] / h - 0.5f), 0, n - 1);
        out.count[i] = clampf(ceilf(high[i] / h + 0.5f), 1, n) - out.first[i];
    }
    return out;
}

static uint64_t most_cells_of(const air *a, box3 box) {
    const float h = (float)a->desc.voxel_size;
    const float wide[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    uint64_t most = !box3_is_empty(box);
    for (int i = 0; i < 3; i++) // a half and a whole cell more on each side, as above
        most *= (uint64_t)fminf(floorf(wide[i] / h) + 3, (float)a->desc.size[i]);
    return most;
}

bool air_source_cells(const air *a, const pass *p, double end, air_cells *out, uint64_t *most) {
    box3 box = box3_infinite(), meshes;
    const field *shape = pass_given_field(p, N_shape);
    if (shape && !field_bounds(shape, p->host->context, &box)) return false;
    if (p->mesh_count) {
        if (!meshes_box(a, p, end, &meshes)) return false;
        box = box3_intersect(box, meshes);
    }
    *out = cells_of(a, box);
    if (most) *most = most_cells_of(a, box);
    return true;
}
