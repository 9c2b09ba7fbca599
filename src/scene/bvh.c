// The meshes as rays see them: their trees, and where they stand in this frame.
#include "scene/bvh.h"
#include "base/error.h"
#include "base/memory.h"
#include "scene/bvh_tree.h"
#include "scene/surfaces.h"
#include <math.h>
#include <string.h>

typedef struct tree { // nodes of the forest
    uint32_t root, end;
    size_t triangles; // of the forest, up to those of this tree
} tree;

typedef struct placement { // the buffer "BvhInstances"
    shared_uvec4 count;
    struct bvh_instance instances[SCENE_BVH_MAX_MESHES];
} placement;

struct scene_bvh {
    scene_mesh *const *meshes;
    tree *trees; // per mesh
    size_t mesh_count;
    bvh_forest forest;
    placement now; // as on the device, once there
    bool written, holes;
    gpu_buffer *buffers[BVH_PARTS];
};

static bool same_mesh(const mesh_data *a, const mesh_data *b) {
    return a->vertices == b->vertices && a->indices == b->indices && a->parts == b->parts;
}

static bool add_tree(scene_bvh *b, size_t index) {
    const mesh_data *data = &b->meshes[index]->data;
    for (size_t i = 0; i < index; i++) {
        if (!same_mesh(&b->meshes[i]->data, data)) continue;
        b->trees[index] = b->trees[i];
        return true;
    }
    b->trees[index].root = (uint32_t)b->forest.node_count;
    if (!bvh_forest_add(&b->forest, data)) return err_prefix("%s: ", b->meshes[index]->name);
    b->trees[index].end = (uint32_t)b->forest.node_count;
    b->trees[index].triangles = b->forest.triangle_count;
    return true;
}

scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count) {
    if (count > SCENE_BVH_MAX_MESHES) {
        err_set("%zu meshes; at most %d are possible", count, SCENE_BVH_MAX_MESHES);
        return NULL;
    }
    scene_bvh *b = mem_alloc(sizeof *b);
    *b = (scene_bvh){
        .meshes = mem_copy(meshes, count * sizeof(scene_mesh *)),
        .trees = mem_alloc(count * sizeof(tree)),
        .mesh_count = count,
    };
    for (size_t i = 0; i < count; i++) {
        if (add_tree(b, i)) continue;
        scene_bvh_destroy(b, NULL);
        return NULL;
    }
    return b;
}

void scene_bvh_destroy(scene_bvh *b, gpu *g) {
    if (!b) return;
    for (int i = 0; i < BVH_PARTS; i++)
        if (b->buffers[i]) gpu_buffer_destroy(g, b->buffers[i]);
    bvh_forest_free(&b->forest);
    mem_free((void *)b->meshes);
    mem_free(b->trees);
    mem_free(b);
}

// ---- on the device ----------------------------------------------------------------------------

static bool make_buffer(scene_bvh *b, gpu *g, scene_bvh_part part, const char *label,
                        const void *data, size_t size) {
    size_t least = size ? size : 16; // a buffer is never empty
    uint64_t most = gpu_get_info(g)->max_storage_range;
    if (least > most)
        return err_set("meshes: %s take %zu MiB; this device can read at most %llu MiB", label,
                       least >> 20, (unsigned long long)most >> 20);
    gpu_buffer_desc desc = {.label = label, .size = least, .kind = GPU_BUFFER_DEVICE};
    b->buffers[part] = gpu_buffer_create(g, &desc);
    return b->buffers[part] && (size == 0 || gpu_buffer_write(g, b->buffers[part], 0, data, size));
}

bool scene_bvh_allocate(scene_bvh *b, gpu *g) {
    if (b->buffers[BVH_INSTANCES]) return true;
    const bvh_forest *f = &b->forest;
    return make_buffer(b, g, BVH_NODES, "boxes of meshes", f->nodes,
                       f->node_count * sizeof *f->nodes) &&
           make_buffer(b, g, BVH_TRIANGLES, "triangles of meshes", f->triangles,
                       f->triangle_count * sizeof *f->triangles) &&
           make_buffer(b, g, BVH_INSTANCES, "placed meshes", &b->now, sizeof b->now);
}

bool scene_bvh_surfaces_fit(const scene_mesh *mesh, gpu *g) {
    return surfaces_largest(&mesh->data) <= gpu_get_info(g)->max_storage_range;
}

bool scene_bvh_allocate_surfaces(scene_bvh *b, gpu *g) {
    if (b->buffers[BVH_TEXELS]) return true;
    surfaces s = {0};
    for (size_t i = 0; i < b->mesh_count; i++) // a tree of several meshes is done after the first
        if (b->trees[i].triangles > s.triangle_count)
            surfaces_add(&s, &b->forest, b->trees[i].triangles, &b->meshes[i]->data);
    b->holes = s.holes;
    bool done = make_buffer(b, g, BVH_SURFACES, "surfaces of meshes", s.triangles,
                            s.triangle_count * sizeof *s.triangles) &&
                make_buffer(b, g, BVH_VERTICES, "vertices of meshes", s.vertices,
                            s.vertex_count * sizeof *s.vertices) &&
                make_buffer(b, g, BVH_MATERIALS, "materials of meshes", s.materials,
                            s.material_count * sizeof *s.materials) &&
                make_buffer(b, g, BVH_TEXELS, "textures of meshes", s.texels,
                            s.texel_count * sizeof *s.texels);
    surfaces_free(&s);
    return done;
}

bool scene_bvh_has_holes(const scene_bvh *b) {
    return b->holes;
}

void scene_bvh_choose(const scene_bvh *b, scene_mesh *const *meshes, size_t count,
                      uint32_t bits[SCENE_BVH_MAX_MESHES / 32]) {
    memset(bits, 0, SCENE_BVH_MAX_MESHES / 8);
    for (size_t i = 0; i < b->mesh_count; i++)
        for (size_t k = 0; k < count; k++)
            if (b->meshes[i] == meshes[k]) bits[i / 32] |= 1u << i % 32;
}

gpu_buffer *scene_bvh_buffer(const scene_bvh *b, scene_bvh_part part) {
    return b->buffers[part];
}

// ---- placed -----------------------------------------------------------------------------------

// The box of a tree's root, moved into the world: all eight corners, and a little more for
// rounding.
static void world_box(const struct bvh_node *root, mat4 transform, struct bvh_instance *out) {
    vec3 box[2];
    for (int i = 0; i < 8; i++) {
        vec3 at;
        for (int a = 0; a < 3; a++) at[a] = i >> a & 1 ? root->high.v[a] : root->low.v[a];
        glm_mat4_mulv3(transform, at, 1, at);
        for (int a = 0; a < 3; a++) {
            box[0][a] = i ? fminf(box[0][a], at[a]) : at[a];
            box[1][a] = i ? fmaxf(box[1][a], at[a]) : at[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        float margin = 1e-5f * fmaxf(fabsf(box[0][a]), fabsf(box[1][a]));
        out->low.v[a] = box[0][a] - margin;
        out->high.v[a] = box[1][a] + margin;
    }
}

// False where nothing would be seen of it: scaled to nothing, or out of all numbers.
static bool invert(mat4 transform, struct bvh_instance *out) {
    mat4 inverse;
    float size = glm_mat4_det(transform);
    if (!isfinite(size) || size == 0) return false;
    glm_mat4_inv(transform, inverse);
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            if (!isfinite(inverse[column][row])) return false;
            out->inverse[row].v[column] = inverse[column][row];
        }
    }
    return true;
}

static bool place(const scene_bvh *b, const field_context *context, placement *out) {
    for (size_t i = 0; i < b->mesh_count; i++) {
        const tree *t = &b->trees[i];
        mat4 transform;
        float tint[4];
        if (!scene_mesh_place(b->meshes[i], context, transform, tint)) return false;
        struct bvh_instance made = {.root = t->root, .end = t->end};
        if (t->root == t->end || !invert(transform, &made)) continue;
        world_box(&b->forest.nodes[t->root], transform, &made);
        memcpy(made.color.v, tint, 3 * sizeof *tint);
        made.color.v[3] = (float)i;
        out->instances[out->count.v[0]++] = made;
    }
    return true;
}

bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context) {
    placement now = {0};
    if (!place(b, context, &now)) return false;
    size_t used = offsetof(placement, instances) + now.count.v[0] * sizeof *now.instances;
    if (b->written && memcmp(&b->now, &now, used) == 0) return true;
    b->now = now;
    b->written = gpu_buffer_write(g, b->buffers[BVH_INSTANCES], 0, &now, used);
    return b->written;
}
